// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// Random houses whose doors open and close while the vehicle is under way: no trajectory touches
// anything or breaks a limit, and every problem comes to an end. SWIFTLET_FULL_TESTS=1: 10,000 of
// them, else 60. SWIFTLET_DOOR_SEEDS=FROM,TO: those.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "control/flight_reference.hpp"
#include "planner/path/replanner.hpp"
#include "planner/trajectory/limits.hpp"
#include "tests/planner/path/maps.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector2d;

constexpr double kRadius = 0.25;       // of the vehicle [m]
constexpr double kLightBarrier = 1.3;  // a door does not close on what is nearer [m]
constexpr double kCell = 0.05;
constexpr double kTimeLimit = 90.0;  // [s]
const Duration kStep = std::chrono::milliseconds(50);

struct Box {
  Vector2d low, high;
  double distance(const Vector2d& p) const {
    return (low - p).cwiseMax(p - high).cwiseMax(Vector2d::Zero()).norm();
  }
};

double on_grid(double x) {
  return std::round(x / kCell) * kCell;
}

/// A hall of 11 x 9 m with walls across, one or two doors in each, and some furniture. All its
/// boxes end on borders of cells, so that their distances are those of the map.
struct House {
  std::vector<Box> walls;
  std::vector<Box> doors;
  std::vector<bool> closed;
  OccupancyGrid grid = test::hall(11.0, 9.0);

  explicit House(std::mt19937& random) {
    std::uniform_real_distribution<double> share(0.0, 1.0);
    walls = {{{0, 0}, {11, 0.1}}, {{0, 8.9}, {11, 9}}, {{0, 0}, {0.1, 9}}, {{10.9, 0}, {11, 9}}};
    const int across = 1 + static_cast<int>(random() % 3);
    for (int i = 0; i < across; ++i) {
      const double x = on_grid(11.0 * (i + 0.7 + 0.6 * share(random)) / (across + 1));
      const int count = 1 + static_cast<int>(random() % 2);
      double from = 0.1;
      for (int k = 0; k < count; ++k) {
        const double room = 8.8 / count;
        const double width = on_grid(0.9 + 0.4 * share(random));
        const double y = on_grid(0.1 + k * room + 0.3 + (room - width - 0.6) * share(random));
        add_wall({{x, from}, {x + 0.1, y}});
        doors.push_back({{x, y}, {x + 0.1, y + width}});
        closed.push_back(false);
        from = y + width;
      }
      add_wall({{x, from}, {x + 0.1, 8.9}});
    }
    for (int i = static_cast<int>(random() % 4); i > 0; --i) {
      const Vector2d low(on_grid(1.0 + 8.0 * share(random)), on_grid(1.0 + 6.0 * share(random)));
      add_wall({low, low + Vector2d(on_grid(0.2 + 0.6 * share(random)),
                                    on_grid(0.2 + 0.6 * share(random)))});
    }
    for (std::size_t i = 0; i < doors.size(); ++i) {
      if (random() % 3 == 0) toggle(i);
    }
  }

  void add_wall(const Box& box) {
    walls.push_back(box);
    test::paint(grid, box.low.x(), box.low.y(), box.high.x(), box.high.y(), CellState::kOccupied);
  }
  void toggle(std::size_t i) {
    closed[i] = !closed[i];
    const Box& d = doors[i];
    test::paint(grid, d.low.x(), d.low.y(), d.high.x(), d.high.y(),
                closed[i] ? CellState::kOccupied : CellState::kFree);
  }
  double clearance(const Vector2d& p) const {
    double nearest = 1e9;
    for (const Box& wall : walls) nearest = std::min(nearest, wall.distance(p));
    for (std::size_t i = 0; i < doors.size(); ++i) {
      if (closed[i]) nearest = std::min(nearest, doors[i].distance(p));
    }
    return nearest;
  }
  Vector2d free_place(std::mt19937& random) const {
    std::uniform_real_distribution<double> x(0.6, 10.4), y(0.6, 8.4);
    Vector2d place;
    do {
      place = {x(random), y(random)};
      // Not under a door either, open or not.
    } while (clearance(place) < 0.45 ||
             std::any_of(doors.begin(), doors.end(),
                         [&](const Box& door) { return door.distance(place) < 0.6; }));
    return place;
  }
};

struct Tally {
  int problems = 0, arrived = 0, given_up = 0, plans = 0, brakes = 0;
  int touching = 0, over_limits = 0, endless = 0;
  double least = 1e9;  // clearance of any trajectory [m]
  std::vector<double> milliseconds;
};

/// Nearest that the rest of a trajectory comes to anything, to half a centimetre [m].
double least_clearance(const Trajectory& trajectory, Time from, const House& house) {
  double least = 1e9;
  const double speed = std::max(trajectory.max_speed(), 0.1);
  const Duration step = from_seconds(0.01 / speed);
  for (Time time = std::max(from, trajectory.start()); time < trajectory.end() + step;
       time += step) {
    least = std::min(least, house.clearance(trajectory.evaluate(time).position.head<2>()));
  }
  return least - 0.005;
}

void fly(std::uint32_t seed, Tally& tally) {
  std::mt19937 random(seed);
  House house(random);
  Replanner::Params params;
  params.seed = seed;
  TrajectoryLimits& limits = params.trajectory.minimum_snap.limits;
  limits.max_speed = 1.2;
  limits.max_acceleration = 1.5;
  const ReferenceLimits braking{1.2, 2.0, 15.0, 2.0, 10.0};  // the commander's
  Replanner replanner(params);

  FlightGoal goal;
  RigidBodyState vehicle;
  vehicle.p_WB << house.free_place(random), 1.2;
  goal.position << house.free_place(random), 1.2;
  Time now{std::chrono::seconds(1)};
  FlatReference at;
  at.position = vehicle.p_WB;
  Trajectory current = resting_at(at, now), next;
  std::optional<Time> braked_until;
  std::exponential_distribution<double> quiet(1.0 / 2.5);
  double next_door = to_seconds(now) + quiet(random);

  ++tally.problems;
  const Time end = now + from_seconds(kTimeLimit);
  for (; now < end; now += kStep) {
    if (!next.empty() && now >= next.start()) current = std::exchange(next, {});
    at = current.evaluate(now);
    vehicle.p_WB = at.position;
    vehicle.v_WB_W = at.velocity;
    const double here = house.clearance(at.position.head<2>());
    if (here < kRadius) ++tally.touching;

    if (to_seconds(now) >= next_door && !house.doors.empty()) {
      next_door = to_seconds(now) + quiet(random);
      const std::size_t door = random() % house.doors.size();
      const bool may =
          house.closed[door] || house.doors[door].distance(at.position.head<2>()) > kLightBarrier;
      if (may) house.toggle(door);
    }
    if (braked_until && now < *braked_until) continue;
    if (std::exchange(braked_until, std::nullopt)) current = resting_at(at, now);

    const auto begin = std::chrono::steady_clock::now();
    const ReplanDecision decision = replanner.step({now, &current, &house.grid, vehicle, goal});
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    switch (decision.action) {
      case ReplanAction::kKeep:
        break;
      case ReplanAction::kFollow: {
        ++tally.plans;
        tally.milliseconds.push_back(took.count());
        next = decision.trajectory;
        const double least = least_clearance(next, now, house);
        tally.least = std::min(tally.least, least);
        if (least < kRadius) ++tally.touching;
        if (!within(extrema(next), limits).ok()) ++tally.over_limits;
        break;
      }
      case ReplanAction::kBrake:
      case ReplanAction::kFail: {
        tally.milliseconds.push_back(took.count());
        const auto brake = FlightReference::brake(now, at, braking);
        ASSERT_TRUE(brake.ok());
        current = brake->trajectory();
        next = {};
        braked_until = brake->end();
        if (least_clearance(current, now, house) < kRadius) ++tally.touching;
        if (decision.action == ReplanAction::kFail) {
          ++tally.given_up;
          return;
        }
        ++tally.brakes;
        break;
      }
    }
    const bool there = (at.position - goal.position).norm() < 0.05 && at.velocity.norm() < 0.01;
    if (there && next.empty()) {
      ++tally.arrived;
      return;
    }
  }
  ++tally.endless;
}

std::pair<std::uint32_t, std::uint32_t> seeds() {
  unsigned from = 0, to = 0;
  const char* asked = std::getenv("SWIFTLET_DOOR_SEEDS");
  if (asked != nullptr && std::sscanf(asked, "%u,%u", &from, &to) == 2) return {from, to};
  const char* full = std::getenv("SWIFTLET_FULL_TESTS");
  return {1, full != nullptr && std::string(full) == "1" ? 10000 : 60};
}

TEST(MovingDoors, NoTrajectoryTouchesOrBreaksALimitAndEveryProblemEnds) {
  const auto [from, to] = seeds();
  Tally tally;
  for (std::uint32_t seed = from; seed <= to; ++seed) {
    const int bad = tally.touching + tally.over_limits + tally.endless;
    fly(seed, tally);
    EXPECT_EQ(tally.touching + tally.over_limits + tally.endless, bad) << "seed " << seed;
  }
  std::sort(tally.milliseconds.begin(), tally.milliseconds.end());
  const auto percentile = [&](double share) {
    return tally.milliseconds[static_cast<std::size_t>(
        share * static_cast<double>(tally.milliseconds.size() - 1))];
  };
  ASSERT_FALSE(tally.milliseconds.empty());
  std::printf(
      "%d problems: %d arrived, %d given up, %d endless; %d plans, %d brakes, %d touching, %d over "
      "limits, least clearance %.3f m; answers p50 %.1f, p99 %.1f, worst %.1f ms\n",
      tally.problems, tally.arrived, tally.given_up, tally.endless, tally.plans, tally.brakes,
      tally.touching, tally.over_limits, tally.least, percentile(0.5), percentile(0.99),
      tally.milliseconds.back());
  EXPECT_EQ(tally.touching, 0);
  EXPECT_EQ(tally.over_limits, 0);
  EXPECT_EQ(tally.endless, 0);
  EXPECT_GT(tally.arrived, tally.problems / 3) << "most of them can be flown";
  EXPECT_GT(tally.given_up, 0) << "and some cannot";
}

}  // namespace
}  // namespace swiftlet
