// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Maps, trajectories and missions to messages and back, over the wire format.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "components/commander/mission_message.hpp"
#include "components/conversions.hpp"
#include "components/lidar_mapper/grid_message.hpp"
#include "components/planner/trajectory_message.hpp"
#include "components/runtime/message.hpp"
#include "planner/trajectory/minimum_snap.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using namespace std::chrono_literals;
namespace status = swiftlet_msgs::msg::Trajectory_Constants;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// As it is after the wire.
template <class T>
T sent(const T& message) {
  const Result<T> received = from_cdr<T>(to_cdr(message));
  EXPECT_TRUE(received.ok());
  return received.ok() ? *received : T();
}

OccupancyGrid random_grid(double resolution) {
  OccupancyGrid::Params params;
  params.resolution = resolution;
  OccupancyGrid grid(params, Vector2d(-1.3, 2.7), 37, 23);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> probability(0.05, 0.97);
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      if (random() % 3 != 0) grid.set_probability({x, y}, probability(random));
    }
  }
  return grid;
}

TEST(GridMessage, RoundTripsStatesAndProbabilitiesToOnePercent) {
  for (const double resolution : {0.05, 0.1, 0.03}) {
    const OccupancyGrid grid = random_grid(resolution);
    const OccupancyGrid back = from_msg(sent(to_msg(grid, Time(3s))), {});
    ASSERT_EQ(back.width(), grid.width());
    ASSERT_EQ(back.height(), grid.height());
    EXPECT_EQ(back.resolution(), resolution) << "not that of a float";
    EXPECT_LT((back.origin() - grid.origin()).norm(), 1e-12);
    int known = 0;
    for (int y = 0; y < grid.height(); ++y) {
      for (int x = 0; x < grid.width(); ++x) {
        const Cell cell{x, y};
        const double p = grid.probability(cell);
        EXPECT_NEAR(back.probability(cell), p, 0.0061);
        // A state may only change where rounding crosses its threshold.
        if (std::abs(p - 0.65) > 0.01 && std::abs(p - 0.35) > 0.01) {
          EXPECT_EQ(back.state(cell), grid.state(cell)) << p;
        }
        known += grid.state(cell) != CellState::kUnknown ? 1 : 0;
      }
    }
    EXPECT_GT(known, 200);
  }
}

TEST(GridMessage, IsLaidOutAsRos2Defines) {
  OccupancyGrid grid({}, Vector2d(-1.0, 2.0), 3, 2);
  grid.set_probability({2, 0}, 0.9);
  grid.set_probability({0, 1}, 0.1);
  const auto message = to_msg(grid, Time(1500ms));
  // Row by row from the lowest y, x first; -1 is unknown.
  EXPECT_THAT(message.data(), ::testing::ElementsAre(-1, -1, 90, 10, -1, -1));
  EXPECT_EQ(message.info().width(), 3u);
  EXPECT_EQ(message.info().height(), 2u);
  EXPECT_EQ(message.info().origin().position().x(), -1.0);
  EXPECT_EQ(message.info().origin().position().y(), 2.0);
  EXPECT_EQ(message.info().origin().orientation().w(), 1.0);
  EXPECT_EQ(message.header().frame_id(), "map");
  EXPECT_EQ(message.header().stamp().sec(), 1);
}

TEST(GridMessage, MessagesThatContradictThemselvesGiveAnEmptyGrid) {
  const auto empty_after = [](auto change) {
    auto message = to_msg(random_grid(0.05), Time(1s));
    change(message);
    return from_msg(message, {}).empty();
  };
  using Map = nav_msgs::msg::OccupancyGrid;
  EXPECT_FALSE(empty_after([](Map&) {}));
  EXPECT_TRUE(empty_after([](Map& m) { m.info().width(38); }));
  EXPECT_TRUE(empty_after([](Map& m) { m.data().pop_back(); }));
  EXPECT_TRUE(empty_after([](Map& m) { m.info().resolution(0.0f); }));
  EXPECT_TRUE(empty_after([](Map& m) { m.info().resolution(-0.05f); }));
  EXPECT_TRUE(empty_after([](Map& m) { m.info().resolution(static_cast<float>(kNan)); }));
  EXPECT_TRUE(
      empty_after([](Map& m) { m.info().resolution(std::numeric_limits<float>::infinity()); }));
  EXPECT_TRUE(empty_after([](Map& m) { m.info().origin().position().x(kNan); }));
  EXPECT_TRUE(empty_after([](Map& m) { m.info().origin().orientation().z(0.7); }));
  EXPECT_TRUE(empty_after([](Map& m) {
    // A product that overflows to the size of the data.
    m.info().width(1u << 31);
    m.info().height(0);
    m.data().clear();
  }));
}

TEST(GridMessage, CellsOutOfRangeDoNoHarm) {
  auto message = to_msg(random_grid(0.05), Time(1s));
  message.data()[0] = 127;
  message.data()[1] = -128;
  const OccupancyGrid back = from_msg(message, {});
  EXPECT_EQ(back.state({0, 0}), CellState::kOccupied);
  EXPECT_EQ(back.state({1, 0}), CellState::kUnknown);
}

Trajectory random_trajectory(Time start) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::vector<TrajectorySegment> segments(3);
  for (TrajectorySegment& segment : segments) {
    segment.duration_s = 0.5 + std::abs(normal(random));
    for (Polynomial& c : segment.coefficients) {
      for (int i = 0; i < kCoefficients; ++i) c[i] = normal(random);
    }
  }
  return Trajectory(start, segments);
}

TEST(TrajectoryMessage, RoundTripsToTheBit) {
  const Trajectory trajectory = random_trajectory(Time(12'345'678'901ns));
  const auto message = sent(to_msg(trajectory, Time(777ns)));
  EXPECT_EQ(message.status(), status::PLANNED);
  EXPECT_EQ(from_msg(message.goal_stamp()), Time(777ns));
  const Trajectory back = from_msg(message);
  EXPECT_EQ(back.start(), trajectory.start());
  EXPECT_EQ(back.duration(), trajectory.duration());
  for (int ms = -100; ms < 4000; ms += 7) {
    const Time t = trajectory.start() + std::chrono::milliseconds(ms);
    const FlatReference is = back.evaluate(t), should = trajectory.evaluate(t);
    EXPECT_EQ(is.position, should.position);
    EXPECT_EQ(is.snap, should.snap);
    EXPECT_EQ(is.yaw, should.yaw);
  }
}

TEST(TrajectoryMessage, NonsenseGivesAnEmptyTrajectory) {
  const auto empty_after = [](auto change) {
    auto message = to_msg(random_trajectory(Time(1s)), Time(1s));
    change(message);
    return from_msg(message).empty();
  };
  using Message = swiftlet_msgs::msg::Trajectory;
  EXPECT_FALSE(empty_after([](Message&) {}));
  EXPECT_TRUE(empty_after([](Message& m) { m.segments().clear(); }));
  EXPECT_TRUE(empty_after([](Message& m) { m.segments()[1].duration(0.0); }));
  EXPECT_TRUE(empty_after([](Message& m) { m.segments()[1].duration(kNan); }));
  EXPECT_TRUE(empty_after([](Message& m) { m.segments()[1].duration(1e12); }));
  EXPECT_TRUE(empty_after([](Message& m) { m.segments()[2].x()[9] = kNan; }));
  EXPECT_TRUE(empty_after([](Message& m) { m.segments()[0].yaw()[0] = 1.0 / 0.0; }));
  EXPECT_TRUE(empty_after([](Message& m) { m.status(status::BRAKE); }));
  EXPECT_TRUE(empty_after([](Message& m) { m.status(status::FAILED); }));
  EXPECT_TRUE(empty_after([](Message& m) { m.status(200); }));
}

TEST(TrajectoryMessage, AFailureCarriesItsReason) {
  const auto message =
      sent(no_trajectory_msg(Time(2s), Time(1s), status::FAILED, "no path", "the door is closed"));
  EXPECT_EQ(message.status(), status::FAILED);
  EXPECT_EQ(message.failure(), "no path");
  EXPECT_EQ(message.reason(), "the door is closed");
  EXPECT_EQ(from_msg(message.goal_stamp()), Time(1s));
  EXPECT_TRUE(from_msg(message).empty());
}

const std::vector<MissionWaypoint> kMission{{{1.0, 2.0, 3.0}, 0.5}, {{-4.0, 5.5, 1.25}, {}}};

TEST(MissionMessage, RoundTripsWaypointsAndChecksum) {
  const auto message = sent(make_mission(Time(1s), "m-1", kMission));
  EXPECT_EQ(message.id(), "m-1");
  EXPECT_EQ(message.checksum(), checksum(message));
  const auto back = waypoints_of(message);
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[0].position, kMission[0].position);
  EXPECT_EQ(back[0].yaw, kMission[0].yaw);
  EXPECT_EQ(back[1].position, kMission[1].position);
  EXPECT_FALSE(back[1].yaw.has_value());
}

TEST(MissionMessage, TheChecksumIsThatOfTheWaypointsAlone) {
  const auto message = make_mission(Time(1s), "m-1", kMission);
  EXPECT_EQ(checksum(make_mission(Time(9s), "other", kMission)), message.checksum());
  const auto changed = [&](auto change) {
    auto other = message;
    change(other);
    return checksum(other) != message.checksum();
  };
  using Message = swiftlet_msgs::msg::Mission;
  EXPECT_FALSE(changed([](Message&) {}));
  EXPECT_TRUE(changed([](Message& m) { m.waypoints()[0].position().x(1.0000001); }));
  EXPECT_TRUE(changed([](Message& m) { m.waypoints()[1].position().z(1.0); }));
  EXPECT_TRUE(changed([](Message& m) { m.waypoints()[0].yaw(0.6); }));
  EXPECT_TRUE(changed([](Message& m) { m.waypoints()[1].has_yaw(true); }));
  EXPECT_TRUE(changed([](Message& m) { m.waypoints().pop_back(); }));
  EXPECT_TRUE(changed([](Message& m) { std::swap(m.waypoints()[0], m.waypoints()[1]); }));
}

}  // namespace
}  // namespace swiftlet
