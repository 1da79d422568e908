// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/path/replanner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/planner/path/maps.hpp"

namespace swiftlet {
namespace {

using testing::HasSubstr;

/// A vehicle that follows its reference without error, and the policy that directs it.
class Flight {
 public:
  Flight(OccupancyGrid grid, const Eigen::Vector3d& start, const Eigen::Vector3d& goal,
         const Replanner::Params& params = {})
      : replanner(params), grid_(std::move(grid)) {
    vehicle.p_WB = start;
    goal_.position = goal;
  }

  ReplanDecision step() {
    if (!current.empty()) {
      const FlatReference reference = current.evaluate(now);
      vehicle.p_WB = reference.position;
      vehicle.v_WB_W = reference.velocity;
    }
    ReplanDecision decision = replanner.step({now, &current, &grid_, vehicle, goal_});
    if (decision.action == ReplanAction::kFollow) {
      ++plans;
      next = decision.trajectory;
    }
    if (decision.action == ReplanAction::kBrake || decision.action == ReplanAction::kFail) {
      current = next = Trajectory();
      vehicle.v_WB_W.setZero();
    }
    return decision;
  }
  /// Until a moment, a step every `period`.
  ReplanDecision fly(double seconds, Duration period = std::chrono::milliseconds(50)) {
    ReplanDecision last;
    for (const Time end = now + from_seconds(seconds); now < end;) {
      last = step();
      if (last.action == ReplanAction::kFail) return last;
      advance(period);
    }
    return last;
  }
  void advance(Duration by) {
    now += by;
    if (!next.empty() && now >= next.start()) {
      current = next;
      next = Trajectory();
    }
  }
  OccupancyGrid& grid() { return grid_; }
  FlightGoal& goal() { return goal_; }

  Replanner replanner;
  Trajectory current, next;
  RigidBodyState vehicle;
  Time now{from_seconds(10.0)};
  int plans = 0;

 private:
  OccupancyGrid grid_;
  FlightGoal goal_;
};

TEST(Replanner, PlansOnceAndStaysWithItInAWorldThatDoesNotChange) {
  Flight flight(test::office(), {1, 1, 1}, {3, 9, 1});
  const ReplanDecision first = flight.step();
  ASSERT_EQ(first.action, ReplanAction::kFollow) << first.reason;
  EXPECT_EQ(first.trajectory.start(), flight.now + flight.replanner.params().lead);
  EXPECT_GE(first.path.points.size(), 2U);
  flight.advance(std::chrono::milliseconds(100));
  flight.fly(60.0);
  EXPECT_EQ(flight.plans, 1);
  EXPECT_LT((flight.vehicle.p_WB - Eigen::Vector3d(3, 9, 1)).norm(), 1e-6);
  EXPECT_EQ(flight.step().action, ReplanAction::kKeep);
}

TEST(Replanner, ReactsAtOnceToABlockedWayAndWithoutAStepInTheReference) {
  Flight flight(test::hall(10, 8), {1, 4, 1}, {9, 4, 1});
  flight.fly(3.0);
  ASSERT_EQ(flight.plans, 1);
  // Between two regular moments of planning.
  flight.advance(std::chrono::milliseconds(30));
  test::paint(flight.grid(), 6.5, 3, 6.7, 5, CellState::kOccupied);
  const ReplanDecision decision = flight.step();
  ASSERT_EQ(decision.action, ReplanAction::kFollow) << decision.reason;
  EXPECT_TRUE(decision.blocked);
  const Time change = decision.trajectory.start();
  const FlatReference old = flight.current.evaluate(change),
                      fresh = decision.trajectory.evaluate(change);
  EXPECT_GT(old.velocity.norm(), 0.3) << "the change should be in flight";
  EXPECT_LT((old.position - fresh.position).norm(), 1e-9);
  EXPECT_LT((old.velocity - fresh.velocity).norm(), 1e-9);
  EXPECT_LT((old.acceleration - fresh.acceleration).norm(), 1e-9);
  EXPECT_LT((old.jerk - fresh.jerk).norm(), 1e-7);
  flight.advance(std::chrono::milliseconds(50));
  flight.fly(30.0);
  EXPECT_LT((flight.vehicle.p_WB - Eigen::Vector3d(9, 4, 1)).norm(), 1e-6);
}

TEST(Replanner, TakesAShortcutThatOpens) {
  OccupancyGrid grid = test::hall(10, 8);
  test::paint(grid, 4.9, 0, 5.1, 6.5, CellState::kOccupied);
  Flight flight(std::move(grid), {1, 1, 1}, {9, 1, 1});
  flight.fly(1.0);
  ASSERT_EQ(flight.plans, 1);
  const double around = to_seconds(flight.current.duration());
  test::paint(flight.grid(), 4.8, 0.15, 5.2, 3.0, CellState::kFree);
  flight.fly(0.5);
  EXPECT_EQ(flight.plans, 2);
  EXPECT_LT(to_seconds(flight.current.duration()), 0.8 * around);
}

TEST(Replanner, NewLimitsCountForWhatIsFlown) {
  Flight flight(test::hall(12, 4), {1, 2, 1}, {11, 2, 1});
  while (flight.current.empty() || flight.current.evaluate(flight.now).velocity.x() < 0.8) {
    flight.fly(0.05);
    ASSERT_LT(to_seconds(flight.now), 30.0);
  }
  Replanner::Params slower = flight.replanner.params();
  slower.trajectory.minimum_snap.limits.max_speed = 0.4;
  flight.replanner.set_params(slower);
  const ReplanDecision decision = flight.step();
  EXPECT_EQ(decision.action, ReplanAction::kBrake) << "it is too fast for them";
  flight.fly(3.0);
  EXPECT_GT(flight.vehicle.v_WB_W.norm(), 0.1) << "from rest it goes on";
  EXPECT_LE(flight.current.max_speed(), 0.4 + 1e-6);
  flight.fly(60.0);
  EXPECT_LT((flight.vehicle.p_WB - Eigen::Vector3d(11, 2, 1)).norm(), 1e-6);
}

TEST(Replanner, NoiseInTheMapIsNoReasonToChange) {
  Flight flight(test::hall(10, 8), {1, 4, 1}, {9, 4, 1});
  flight.fly(2.0);
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    // Cells along the walls come and go.
    const Cell cell{static_cast<int>(2 + random() % 190), random() % 2 == 0 ? 2 : 157};
    flight.grid().set_state(cell, i % 2 == 0 ? CellState::kOccupied : CellState::kFree);
    flight.fly(0.05);
  }
  EXPECT_EQ(flight.plans, 1);
}

TEST(Replanner, AClosedDoorEndsWithTheReasonWithinItsTime) {
  OccupancyGrid grid = test::office();
  test::paint(grid, 12, 5.95, 12.9, 6.1, CellState::kOccupied);
  Flight flight(std::move(grid), {1, 1, 1}, {3, 9, 1});
  const Time begin = flight.now;
  const ReplanDecision first = flight.step();
  EXPECT_EQ(first.action, ReplanAction::kKeep);
  EXPECT_THAT(first.reason, HasSubstr("no path"));
  const ReplanDecision last = flight.fly(5.0);
  EXPECT_EQ(last.action, ReplanAction::kFail);
  EXPECT_EQ(last.failure, PlanFailure::kNoPath);
  EXPECT_THAT(last.reason, HasSubstr("no path"));
  EXPECT_LE(to_seconds(flight.now - begin), 0.9);
  EXPECT_EQ(flight.plans, 0);
}

TEST(Replanner, ADoorThatOpensInTimeIsTaken) {
  OccupancyGrid grid = test::office();
  test::paint(grid, 12, 5.95, 12.9, 6.1, CellState::kOccupied);
  Flight flight(std::move(grid), {1, 1, 1}, {3, 9, 1});
  flight.fly(0.6);
  test::paint(flight.grid(), 12, 5.95, 12.9, 6.1, CellState::kFree);
  flight.fly(0.3);
  EXPECT_EQ(flight.plans, 1);
}

TEST(Replanner, ADoorThatClosesInFlightEndsBeforeIt) {
  Flight flight(test::office(), {1, 1, 1}, {3, 9, 1});
  flight.fly(10.0);
  ASSERT_EQ(flight.plans, 1);
  test::paint(flight.grid(), 12, 5.95, 12.9, 6.1, CellState::kOccupied);
  const ReplanDecision last = flight.fly(5.0);
  EXPECT_EQ(last.action, ReplanAction::kFail);
  EXPECT_EQ(last.failure, PlanFailure::kNoPath);
  EXPECT_TRUE(last.blocked);
  EXPECT_GT(test::true_clearance(flight.grid(), flight.vehicle.p_WB.head<2>()), 0.35);
}

TEST(Replanner, SaysAtOnceThatItMustBrake) {
  Flight flight(test::hall(10, 4), {1, 2, 1}, {9, 2, 1});
  while (flight.current.empty() || flight.current.evaluate(flight.now).velocity.x() < 0.8) {
    flight.fly(0.05);
    ASSERT_LT(to_seconds(flight.now), 30.0);
  }
  // A wall with no way around, hardly more than the vehicle's reach ahead of it.
  const double x = flight.vehicle.p_WB.x() + 0.85;
  test::paint(flight.grid(), x, 0, x + 0.15, 4, CellState::kOccupied);
  const ReplanDecision decision = flight.step();
  EXPECT_EQ(decision.action, ReplanAction::kBrake);
  EXPECT_TRUE(decision.blocked);
  EXPECT_FALSE(decision.reason.empty());
  // Standing, it finds that there is no way, and gives up in time.
  EXPECT_EQ(flight.fly(3.0).action, ReplanAction::kFail);
}

TEST(Replanner, AfterBrakingItGoesAroundFromRest) {
  Flight flight(test::hall(10, 8), {1, 4, 1}, {9, 4, 1});
  while (flight.current.empty() || flight.current.evaluate(flight.now).velocity.x() < 0.8) {
    flight.fly(0.05);
    ASSERT_LT(to_seconds(flight.now), 30.0);
  }
  const double x = flight.vehicle.p_WB.x() + 0.6;
  test::paint(flight.grid(), x, 2.5, x + 0.15, 5.5, CellState::kOccupied);
  EXPECT_EQ(flight.step().action, ReplanAction::kBrake);
  flight.fly(40.0);
  EXPECT_LT((flight.vehicle.p_WB - Eigen::Vector3d(9, 4, 1)).norm(), 1e-6);
}

TEST(Replanner, ANewGoalIsPlannedToAtOnceAndInFlight) {
  Flight flight(test::hall(10, 8), {1, 4, 1}, {9, 4, 1});
  flight.fly(2.0);
  flight.advance(std::chrono::milliseconds(20));
  flight.goal().position = {5, 7, 1.2};
  const ReplanDecision decision = flight.step();
  ASSERT_EQ(decision.action, ReplanAction::kFollow) << decision.reason;
  const Time change = decision.trajectory.start();
  EXPECT_LT(
      (flight.current.evaluate(change).velocity - decision.trajectory.evaluate(change).velocity)
          .norm(),
      1e-9);
  EXPECT_LT((decision.trajectory.final_reference().position - flight.goal().position).norm(), 1e-9);
}

TEST(Replanner, ATrajectoryThatIsAboutToBeginIsAlreadyTheCurrentOne) {
  OccupancyGrid grid = test::hall(10, 8);
  Replanner replanner;
  RigidBodyState vehicle;
  vehicle.p_WB = {1, 4, 1};
  FlightGoal goal{{9, 4, 1}, 0.0};
  const Time now(from_seconds(5.0));
  const ReplanDecision first = replanner.step({now, nullptr, &grid, vehicle, goal});
  ASSERT_EQ(first.action, ReplanAction::kFollow);
  // Before it begins, the goal changes.
  goal.position = {9, 6, 1};
  const Time soon = now + std::chrono::milliseconds(1);
  const ReplanDecision second = replanner.step({soon, &first.trajectory, &grid, vehicle, goal});
  ASSERT_EQ(second.action, ReplanAction::kFollow);
  EXPECT_GE(second.trajectory.start(), first.trajectory.start());
  const Time change = second.trajectory.start();
  EXPECT_LT(
      (first.trajectory.evaluate(change).jerk - second.trajectory.evaluate(change).jerk).norm(),
      1e-6);
}

TEST(Replanner, FarOffItsReferenceItPlansFromTheVehicle) {
  Flight flight(test::hall(10, 8), {1, 4, 1}, {9, 4, 1});
  flight.fly(2.0);
  const Trajectory current = flight.current;
  RigidBodyState blown = flight.vehicle;
  blown.p_WB.y() += 1.0;
  OccupancyGrid grid = flight.grid();
  const ReplanDecision decision = flight.replanner.step(
      {flight.now + std::chrono::seconds(1), &current, &grid, blown, flight.goal()});
  ASSERT_EQ(decision.action, ReplanAction::kFollow) << decision.reason;
  EXPECT_LT(
      (decision.trajectory.evaluate(decision.trajectory.start()).position - blown.p_WB).norm(),
      1e-9);
}

TEST(Replanner, WithoutAMapOrWithNonsenseItFailsInItsTime) {
  for (const bool nonsense : {false, true}) {
    Flight flight(OccupancyGrid(), {1, 1, 1}, {3, 3, 1});
    if (nonsense) flight.vehicle.p_WB.x() = std::nan("");
    const ReplanDecision last = flight.fly(3.0);
    EXPECT_EQ(last.action, ReplanAction::kFail);
    EXPECT_FALSE(last.reason.empty());
    EXPECT_LE(to_seconds(flight.now), 10.9);
  }
}

TEST(Replanner, WithoutAMapAnyMoreWhatIsFlownIsNotFlownBlindly) {
  Flight flight(test::office(), {1, 1, 1}, {3, 9, 1});
  flight.fly(3.0);
  ASSERT_FALSE(flight.current.empty());
  flight.grid() = OccupancyGrid();
  const ReplanDecision last = flight.fly(3.0);
  EXPECT_EQ(last.action, ReplanAction::kFail);
  EXPECT_FALSE(last.reason.empty());
}

TEST(Replanner, FliesOnFarOutsideOfAMapThatStaysAsItIs) {
  OccupancyGrid grid = test::hall(6, 6);
  test::paint(grid, 5.85, 2.0, 6.1, 4.0, CellState::kFree);
  Flight flight(grid, {3, 3, 1}, {60, 50, 1});
  flight.fly(120.0);
  EXPECT_LT((flight.vehicle.p_WB - Eigen::Vector3d(60, 50, 1)).norm(), 0.05);
}

TEST(Replanner, TheSameFlightTwiceIsTheSameToTheBit) {
  const auto run = [] {
    Flight flight(test::office(), {1, 1, 1}, {3, 9, 1});
    flight.fly(8.0);
    test::paint(flight.grid(), 7, 4.9, 7.3, 6, CellState::kOccupied);
    flight.fly(8.0);
    std::vector<double> all;
    for (const auto& segment : flight.current.segments()) {
      all.push_back(segment.duration_s);
      for (const auto& c : segment.coefficients)
        all.insert(all.end(), c.data(), c.data() + c.size());
    }
    return all;
  };
  const auto first = run();
  EXPECT_GT(first.size(), 100U);
  EXPECT_EQ(first, run());
}

}  // namespace
}  // namespace swiftlet
