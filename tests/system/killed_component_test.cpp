// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The office flight in real processes, of which one after the other is killed.
#include <csignal>

#include "tests/system/flight_observer.hpp"
#include "tests/system/system_test.hpp"

namespace swiftlet::test {
namespace {

using testing::HasSubstr;

const std::vector<std::string> kComponents{"estimator", "flight_controller", "lidar_mapper",
                                           "planner", "commander"};

/// A moment of the flight.
struct Moment {
  const char* name;
  bool (*reached)(const FlightObserver::Seen& seen);
};

constexpr unsigned kHover = swiftlet_msgs::msg::VehicleStatus_Constants::HOVER;

const Moment kMoments[]{
    {"Climb", [](const FlightObserver::Seen& seen) { return seen.position.z() > 0.9; }},
    {"Cruise",
     [](const FlightObserver::Seen& seen) { return seen.waypoint >= 1 && seen.speed > 0.6; }},
    {"Doorway",
     [](const FlightObserver::Seen& seen) {
       return (seen.position.head<2>() - Eigen::Vector2d(5.45, 2.01)).norm() < 0.25;
     }},
};

class KilledComponent : public SystemTest {
 protected:
  void SetUp() override {
    if (kSlowdown > 1) GTEST_SKIP() << "the sanitizers are too slow to fly in real time";
  }

  void start_all(int seed, bool with_standby) {
    observer_.emplace(domain());
    const std::string seed_text = std::to_string(seed);
    others_.push_back(
        start({"run", "sim", "--scenario", office(), "--param", "sim.seed=" + seed_text}));
    for (const std::string& component : kComponents) {
      Arguments arguments{"run", component};
      if (component == "planner") {
        arguments.insert(arguments.end(), {"--param", "planner.seed=" + seed_text});
      }
      first_.emplace(component, start(arguments));
      if (!with_standby) continue;
      arguments.insert(arguments.end(), {"--standby", "1"});
      standby_.emplace(component, start(arguments));
    }
    pilot_.emplace(start({"run", "pilot", "--scenario", office()}));
  }

  bool reaches(const Moment& moment, Seconds limit) {
    return becomes_true(limit, [&] { return moment.reached(observer_->seen()); });
  }

  void kill(const std::string& component) {
    Process& process = first_.at(component);
    ASSERT_TRUE(process.running()) << process.err();
    process.send(SIGKILL);
    ASSERT_TRUE(process.wait(kExitLimit));
  }

  std::optional<FlightObserver> observer_;
  std::vector<Process> others_;
  std::map<std::string, Process> first_;
  std::map<std::string, Process> standby_;
  std::optional<Process> pilot_;
};

/// What is said, and by whom, when a component is killed that has no successor.
void expect_reason(const std::string& component, const std::string& pilot,
                   const std::string& flight_controller) {
  if (component == "estimator") {
    EXPECT_THAT(pilot, HasSubstr("no odometry for"));
    EXPECT_THAT(flight_controller, HasSubstr("no odometry for"));
  } else if (component == "commander") {
    EXPECT_THAT(pilot, HasSubstr("the commander is silent"));
    EXPECT_THAT(flight_controller, HasSubstr("nobody sends setpoints for"));
  } else {
    EXPECT_THAT(pilot, HasSubstr("the " + component + " fell silent"));
  }
}

struct Case {
  std::string component;
  const Moment* moment;
  int seed;
};
std::string name_of(const testing::TestParamInfo<Case>& info) {
  return info.param.component + info.param.moment->name + std::to_string(info.param.seed);
}

class WithoutStandby : public KilledComponent, public testing::WithParamInterface<Case> {};

TEST_P(WithoutStandby, NothingIsTouchedAndTheReasonIsSaid) {
  const auto& [component, moment, seed] = GetParam();
  const bool long_form = !(seed == 1 && moment->name == std::string("Cruise"));
  if (long_form && !full_tests()) GTEST_SKIP() << "set SWIFTLET_FULL_TESTS=1 to run it";
  start_all(seed, false);
  ASSERT_TRUE(reaches(*moment, Seconds(90.0))) << pilot_->err();
  kill(component);
  const auto end = pilot_->wait(Seconds(60.0));
  ASSERT_TRUE(end);
  const FlightObserver::Seen seen = observer_->seen();
  if (component == "flight_controller") {
    // Nobody drives the rotors: their controllers stop them, and the vehicle falls.
    EXPECT_THAT(others_[0].err(), HasSubstr("motors stopped"));
  } else {
    EXPECT_EQ(seen.contacts, 0u) << "touched " << seen.last_contact;
  }
  EXPECT_EQ(end->exit_code, 1) << end->err;
  expect_reason(component, end->err, first_.at("flight_controller").err());
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  // 5 components at 3 moments with 4 seeds; of the last seed only half: 50 flights and a few.
  for (int seed = 1; seed <= 4; ++seed) {
    for (const std::string& component : kComponents) {
      for (const Moment& moment : kMoments) {
        if (seed < 4 || moment.name != std::string("Climb")) {
          cases.push_back({component, &moment, seed});
        }
      }
    }
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(All, WithoutStandby, testing::ValuesIn(all_cases()), name_of);

class WithStandby : public KilledComponent, public testing::WithParamInterface<int> {};

TEST_P(WithStandby, TheMissionIsFlownAlthoughEachIsKilledInTurn) {
  const int round = GetParam();
  if (round > 0 && !full_tests()) GTEST_SKIP() << "set SWIFTLET_FULL_TESTS=1 to run it";
  start_all(1 + round, true);
  // One after the other in flight, in another order each time.
  std::vector<std::string> order = kComponents;
  std::rotate(order.begin(), order.begin() + round % static_cast<int>(order.size()), order.end());
  ASSERT_TRUE(reaches(kMoments[round % 3], Seconds(90.0))) << pilot_->err();
  observer_->forget_gaps();
  for (const std::string& component : order) {
    kill(component);
    const unsigned waypoint = observer_->seen().waypoint;
    // The next one when the vehicle has got on, in the first half of the flight.
    (void)becomes_true(Seconds(6.0), [&] {
      const FlightObserver::Seen seen = observer_->seen();
      return seen.waypoint > waypoint && seen.speed > 0.4;
    });
    const FlightObserver::Seen seen = observer_->seen();
    EXPECT_LT(seen.longest_setpoint_gap, 0.2) << "after the end of the " << component;
    EXPECT_LT(seen.longest_odometry_gap, 0.2) << "after the end of the " << component;
    EXPECT_LT(seen.longest_motors_gap, 0.1)
        << "after the end of the " << component << ": the rotors would stop";
  }
  const auto end = pilot_->wait(Seconds(150.0));
  ASSERT_TRUE(end);
  EXPECT_EQ(end->exit_code, 0) << end->err;
  EXPECT_EQ(observer_->seen().contacts, 0u) << "touched " << observer_->seen().last_contact;
}

INSTANTIATE_TEST_SUITE_P(Rounds, WithStandby, testing::Range(0, 10));

}  // namespace
}  // namespace swiftlet::test
