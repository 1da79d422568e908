// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Exploration: what the director does with the explorer's orders, and without them.
#include <cmath>
#include <limits>

#include "control/flight_director.hpp"
#include "tests/control/director_flight.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector2d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Kind = ExplorationOrder::Kind;

/// In Indoor Exploration, with a planner that answers each goal once, and an explorer that says
/// `order` twice a second.
struct Exploring : DirectorFlight {
  Exploring() {
    take_off();
    answer_once();
    transitions.clear();
    EXPECT_TRUE(director.request(Request::explore(), now).ok());
  }
  void step() {
    if (order && now - said >= std::chrono::milliseconds(500)) {
      said = now;
      director.set_exploration(*order, now);
    }
    tick();
  }
  template <class Condition>
  bool step_until(Condition condition, double limit_s = 30.0) {
    for (const Time end = now + seconds(limit_s); now < end && !condition();) step();
    return condition();
  }
  void look(double x, double y) { order = ExplorationOrder{Kind::kLook, {x, y}, ""}; }
  bool is_at(double x, double y) const {
    return (vehicle.p_WB.head<2>() - Vector2d(x, y)).norm() < 0.02;
  }
  bool ends() {
    return step_until([this] { return mode() != Mode::kIndoorExploration; });
  }

  std::optional<ExplorationOrder> order;
  Time said{};
};

TEST(FlightDirectorExploration, FliesWhereTheExplorerSaysAndHomeAtTheEnd) {
  Exploring flight;
  flight.look(2.0, 1.0);
  ASSERT_TRUE(flight.step_until([&] { return flight.is_at(2.0, 1.0); }));
  EXPECT_NEAR(flight.vehicle.p_WB.z(), 1.2, 1e-6) << "at the height of its beginning";
  flight.look(-1.0, 3.0);
  ASSERT_TRUE(flight.step_until([&] { return flight.is_at(-1.0, 3.0); }));
  EXPECT_FALSE(flight.status().mission_done);
  flight.order->kind = Kind::kFinished;
  ASSERT_TRUE(flight.ends());
  EXPECT_TRUE(flight.is_at(0.0, 0.0)) << "over the take-off point";
  EXPECT_TRUE(flight.status().mission_done);
  EXPECT_THAT(flight.transitions, ElementsAre("Indoor Exploration -> Hover: mission finished"));
}

TEST(FlightDirectorExploration, TurnsToAnotherPlaceInFlightWithoutAStop) {
  Exploring flight;
  flight.look(3.0, 0.0);
  const auto speed = [&] { return flight.last.setpoint.reference.velocity.norm(); };
  ASSERT_TRUE(flight.step_until([&] { return speed() > 0.8; }));
  flight.look(3.0, 1.5);
  double slowest = 10.0;
  ASSERT_TRUE(flight.step_until([&] {
    slowest = std::min(slowest, speed());
    return flight.vehicle.p_WB.y() > 0.5;
  }));
  EXPECT_GT(slowest, 0.3);
  ASSERT_TRUE(flight.step_until([&] { return flight.is_at(3.0, 1.5); }));
}

TEST(FlightDirectorExploration, APlaceWithoutAWayEndsNothingWhereAnotherOneIsNamed) {
  Exploring flight;
  const auto planner = flight.planner;
  flight.planner = [&](const PlanGoal& goal) {
    if (goal.waypoint.position.x() < 1.5) return planner(goal);
    flight.director.set_plan({goal.identity, {}, false, "no path", "the door is closed"});
  };
  flight.look(2.0, 0.0);
  ASSERT_FALSE(flight.step_until([&] { return flight.mode() != Mode::kIndoorExploration; }, 3.0));
  flight.look(1.0, 0.0);
  ASSERT_TRUE(flight.step_until([&] { return flight.is_at(1.0, 0.0); }));
  ASSERT_TRUE(flight.step_until([&] { return flight.vehicle.v_WB_W.isZero(0.0); }));
  // One that insists is not waited for.
  flight.look(2.0, 0.0);
  ASSERT_TRUE(flight.ends());
  EXPECT_THAT(flight.transitions,
              ElementsAre("Indoor Exploration -> Hover: no path to (2.00, 0.00): the door is "
                          "closed"));
  EXPECT_FALSE(flight.status().mission_done);
}

TEST(FlightDirectorExploration, NothingIsWaitedForForEver) {
  Exploring silent;
  ASSERT_TRUE(silent.ends());
  EXPECT_THAT(silent.transitions.back(), HasSubstr("the explorer was not heard for 5.0 s"));

  Exploring stuck;
  stuck.order = ExplorationOrder{Kind::kStuck, Vector2d::Zero(), "there is no map yet"};
  ASSERT_TRUE(stuck.ends());
  EXPECT_THAT(stuck.transitions.back(), HasSubstr("stuck: there is no map yet"));

  Exploring insisting;
  insisting.look(1.0, 0.0);
  ASSERT_TRUE(insisting.ends());
  EXPECT_THAT(insisting.transitions.back(), HasSubstr("(1.00, 0.00) again and again"));

  Exploring unplanned;
  unplanned.planner = nullptr;
  unplanned.look(1.0, 0.0);
  ASSERT_TRUE(unplanned.ends());
  EXPECT_THAT(unplanned.transitions.back(), HasSubstr("no plan to (1.00, 0.00) within"));

  Exploring alone;
  alone.look(3.0, 0.0);
  alone.step_until([&] { return alone.vehicle.p_WB.x() > 1.0; });
  alone.director.set_guidance_problem("lidar_mapper: silent for 0.3 s");
  ASSERT_TRUE(alone.ends());
  EXPECT_THAT(alone.transitions.back(), HasSubstr("lidar_mapper: silent"));

  Exploring astray;  // what is no place is as silence
  const double nan = std::numeric_limits<double>::quiet_NaN();
  astray.look(nan, 0.0);
  ASSERT_TRUE(astray.ends());
  EXPECT_THAT(astray.transitions.back(), HasSubstr("was not heard"));
}

TEST(FlightDirectorExploration, AnotherDirectorGoesOnWithIt) {
  Exploring flight;
  flight.look(3.0, 1.0);
  ASSERT_TRUE(flight.step_until([&] { return flight.vehicle.p_WB.x() > 1.0; }));
  FlightDirector successor(settled());
  successor.restore(flight.director.state());
  // What it heard in an earlier exploration is no order for this one.
  successor.set_exploration({Kind::kFinished, Vector2d::Zero(), ""}, flight.now - seconds(60.0));
  successor.restore(flight.director.state());
  flight.director = successor;
  flight.feed();
  ASSERT_TRUE(flight.step_until([&] {
    EXPECT_NE(flight.last.goal->waypoint.position.x(), 0.0) << "goes home";
    return flight.is_at(3.0, 1.0);
  }));
  EXPECT_TRUE(flight.transitions.empty());
}

}  // namespace
}  // namespace swiftlet::test
