// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// A flight by the pose that comes over UDP: simulator without a phone, a phone beside it, and the
// link between.
#include <algorithm>
#include <csignal>
#include <thread>

#include "tests/system/flight_observer.hpp"
#include "tests/system/live_vehicle.hpp"

namespace swiftlet::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

constexpr double kJump = 0.8;  // [m]
constexpr std::size_t kLinkProcess = 1;
constexpr std::size_t kPhoneProcess = 4;

class PhoneFlight : public LiveVehicleTest {
 protected:
  void SetUp() override {
    if (kSlowdown > 1) GTEST_SKIP() << "the sanitizers are too slow to fly in real time";
  }

  void start_all(const Arguments& phone_options) {
    observer_.emplace(domain());
    const std::string parameters = write("phone.yaml",
                                         "sim: {phone: false}\n"
                                         "phone_link:\n"
                                         "  port: " +
                                             port_ +
                                             "\n"
                                             "  start: {position: [1.0, 1.0, 0.12], poses: 60}\n");
    hosts_ = {{"run", "sim", "--scenario", hop(), "--params", parameters},
              {"run", "phone_link", "estimator", "flight_controller", "--params", parameters},
              {"run", "lidar_mapper", "planner"},
              {"run", "commander"}};
    for (const Arguments& host : hosts_) processes_.push_back(start(host));
    Arguments phone{"phone-sim",      "--follow", "--scenario",    hop(), "--port",   port_,
                    "--clock-offset", "5000",     "--clock-drift", "60",  "--jitter", "2"};
    phone.insert(phone.end(), phone_options.begin(), phone_options.end());
    processes_.push_back(start(phone));
  }
  void take_off() {
    ASSERT_TRUE(becomes_ready()) << processes_[kLinkProcess].err();
    command({"arm"});
    command({"takeoff", "1.0"});
    ends_in("Takeoff", "Hover", Seconds(20.0));
  }
  std::string link_log() const { return processes_[kLinkProcess].err(); }
  /// Estimated position less the true one, as both are heard at about the same moment [m].
  double error() {
    const nlohmann::json now = status();
    if (!now.contains("position_m")) return 1e9;
    const auto& position = now["position_m"];
    const Eigen::Vector3d estimate(position[0].get<double>(), position[1].get<double>(),
                                   position[2].get<double>());
    return (estimate - observer_->seen().position).norm();
  }

  const std::string port_ = std::to_string(18000 + domain());
  std::optional<FlightObserver> observer_;
};

TEST_F(PhoneFlight, FliesByUdpAndHeedsNoSecondSender) {
  start_all({});
  ASSERT_NO_FATAL_FAILURE(take_off());
  EXPECT_LT(error(), 0.25);

  // Another one, somewhere else, at the same port.
  Process second = start({"phone-sim", "--trajectory", "circle", "--port", port_, "--rate", "100"});
  ASSERT_TRUE(becomes_true(kStartLimit, [&] {
    return link_log().find("foreign") != std::string::npos;
  })) << link_log();

  command({"goto", "2.5", "2.0"});
  ends_in("Indoor Navigation", "Hover", Seconds(40.0));
  EXPECT_LT((observer_->seen().position.head<2>() - Eigen::Vector2d(2.5, 2.0)).norm(), 0.35);
  expect_end(second, SIGTERM, 0);
  EXPECT_LT(error(), 0.25);

  command({"land"});
  ends_in("Land", "Grounded", Seconds(20.0));
  EXPECT_EQ(observer_->seen().contacts, 0U) << observer_->seen().last_contact;
  EXPECT_THAT(link_log(), Not(HasSubstr("found itself")));
  stop_vehicle();
}

TEST_F(PhoneFlight, FollowsAJumpOfThePhoneWithoutAStep) {
  // The phone says that it is lower than it said, so the vehicle climbs.
  start_all({"--jump-at", "45", "--jump", "0", "0", std::to_string(-kJump), "0"});
  ASSERT_NO_FATAL_FAILURE(take_off());
  const double height = observer_->seen().position.z();
  ASSERT_THAT(link_log(), Not(HasSubstr("found itself"))) << "too early: the phone has jumped";
  double fastest = 0.0;
  const auto watch = [&] { fastest = std::max(fastest, observer_->seen().speed); };
  ASSERT_TRUE(becomes_true(Seconds(50.0), [&] {
    fastest = 0.0;
    return link_log().find("found itself") != std::string::npos;
  })) << link_log();

  const bool followed = becomes_true(Seconds(20.0), [&] {
    watch();
    return observer_->seen().position.z() > height + kJump - 0.15;
  });
  EXPECT_TRUE(followed) << observer_->seen().position.z() << " from " << height;
  EXPECT_LT(fastest, 0.45) << "at 0.1 m/s, and what hovering needs besides";
  EXPECT_EQ(status()["mode"], "Hover");
  EXPECT_EQ(observer_->seen().contacts, 0U);

  command({"land"});
  ends_in("Land", "Grounded", Seconds(30.0));
  stop_vehicle();
}

TEST_F(PhoneFlight, WithoutAPhoneArmingIsRefusedWithTheReason) {
  start_all({});
  ASSERT_TRUE(becomes_ready()) << link_log();
  expect_end(processes_[kPhoneProcess], SIGTERM, 0);
  ASSERT_TRUE(status_becomes("not ready", Seconds(10.0), [](const nlohmann::json& status) {
    return status["ready"] == false;
  }));
  const Finished refused = gcs({"arm"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, testing::AnyOf(HasSubstr("phone"), HasSubstr("odometry")));
}

}  // namespace
}  // namespace swiftlet::test
