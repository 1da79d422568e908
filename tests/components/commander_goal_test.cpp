// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Goals as RViz sends them, to the real commander in lockstep.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "components/mode_message.hpp"
#include "estimation/geometry/so3.hpp"
#include "tests/components/component_bench.hpp"

namespace swiftlet::test {
namespace {

using namespace std::chrono_literals;
using geometry_msgs::msg::PoseStamped;
using swiftlet_msgs::msg::CommandAck;
using swiftlet_msgs::msg::VehicleStatus;
using ::testing::HasSubstr;
namespace command = swiftlet_msgs::msg::ModeCommand_Constants;

constexpr Time kAirborne = Time(5s);  // by then it hovers
constexpr double kAltitude = 1.0;

PoseStamped goal_pose(Time stamp, double x, double z = 0.0, double yaw = 0.0) {
  PoseStamped goal;
  goal.header(make_header(stamp, "map"));
  goal.pose(to_pose({x, 1.0, z}, from_yaw(yaw)));
  return goal;
}

/// A vehicle that is always exactly where it is told to be, taken off to kAltitude; no planner.
struct GoalBench : Bench {
  std::vector<PoseStamped>& goals = record(topic::goal);  // what the planner is asked for
  std::vector<VehicleStatus>& status = record(topic::vehicle_status);
  std::vector<CommandAck>& acks = record(topic::mode_ack);
  std::shared_ptr<Publisher<PoseStamped>> sender;
  std::shared_ptr<Publisher<swiftlet_msgs::msg::ModeCommand>> mode;

  GoalBench() : Bench("commander", "settling_to_arm: 0") {
    const auto position = std::make_shared<Eigen::Vector3d>(0, 0, 0);
    probe.subscribe(topic::setpoint, [position](const swiftlet_msgs::msg::Setpoint& setpoint) {
      *position = from_msg(setpoint.position());
    });
    every(topic::odometry, 4ms, Time{}, [position](Time now) {
      RigidBodyState state;
      state.p_WB = *position;
      auto odometry = to_odometry(now, state);
      for (std::size_t i = 0; i < 6; ++i) odometry.pose().covariance()[7 * i] = 1e-4;
      return odometry;
    });
    every(topic::range_down, 50ms, Time{}, [position](Time) {
      sensor_msgs::msg::Range range;
      range.range(static_cast<float>(position->z() + 0.15));
      return range;
    });
    send_motors();
    sender = std::make_shared<Publisher<PoseStamped>>(probe.advertise(topic::goal_pose));
    mode =
        std::make_shared<Publisher<swiftlet_msgs::msg::ModeCommand>>(probe.advertise(topic::mode));
  }

  void take_off() {
    for (const auto& [time, what] : {std::pair{500ms, command::ARM}, {600ms, command::TAKEOFF}}) {
      at(Time(time), mode, [what = what](Time now) {
        swiftlet_msgs::msg::ModeCommand message;
        message.header(make_header(now, frame::kMap));
        message.id(std::to_string(what));
        message.command(what);
        message.altitude(kAltitude);
        return message;
      });
    }
  }
  void send(Time time, const PoseStamped& goal) {
    at(time, sender, [goal](Time) { return goal; });
  }
  const VehicleStatus& status_at(Time time) const {
    const auto later = std::find_if(status.begin(), status.end(), [time](const auto& s) {
      return from_msg(s.header().stamp()) > time;
    });
    EXPECT_NE(later, status.begin());
    return *std::prev(later);
  }
  Mode mode_at(Time time) const {
    for (const Mode candidate : kModes) {
      if (to_msg(candidate) == status_at(time).mode()) return candidate;
    }
    return Mode::kGrounded;
  }
  /// Missions are told apart by when they were begun.
  std::set<std::int64_t> missions() const {
    std::set<std::int64_t> begun;
    for (const PoseStamped& goal : goals) {
      begun.insert(from_msg(goal.header().stamp()).time_since_epoch().count());
    }
    return begun;
  }
};

TEST(CommanderGoalPose, IsAMissionOfOneWaypointAtThePresentHeight) {
  GoalBench bench;
  bench.take_off();
  bench.send(kAirborne, goal_pose(kAirborne, 2.0, 0.0, 0.5));
  bench.run_until(kAirborne + 500ms);
  ASSERT_EQ(bench.mode_at(kAirborne - 1ms), Mode::kHover) << bench.status.back().reason();
  EXPECT_EQ(bench.status.back().reason(), "mission requested");
  EXPECT_EQ(bench.status.back().waypoint_count(), 1u);
  EXPECT_THAT(bench.status.back().mission_id(), HasSubstr("goal_pose 5.0"));
  ASSERT_FALSE(bench.goals.empty());
  const auto& pose = bench.goals.back().pose();
  EXPECT_EQ(pose.position().x(), 2.0);
  EXPECT_EQ(pose.position().y(), 1.0);
  EXPECT_NEAR(pose.position().z(), kAltitude, 1e-9);
  EXPECT_NEAR(yaw_of(from_msg(pose.orientation())), 0.5, 1e-9);
}

TEST(CommanderGoalPose, WithAHeightIsFlownAtThatHeight) {
  GoalBench bench;
  bench.take_off();
  bench.send(kAirborne, goal_pose(kAirborne, 2.0, 1.75));
  bench.run_until(kAirborne + 500ms);
  ASSERT_FALSE(bench.goals.empty());
  EXPECT_EQ(bench.goals.back().pose().position().z(), 1.75);
}

TEST(CommanderGoalPose, ThatComesTwiceIsOneMissionOneWithAnotherStampIsAnother) {
  GoalBench bench;
  bench.take_off();
  bench.send(kAirborne, goal_pose(kAirborne, 2.0));
  // Without an answer of a planner the mission ends after two seconds.
  bench.send(kAirborne + 4s, goal_pose(kAirborne, 2.0));
  bench.send(kAirborne + 5s, goal_pose(kAirborne + 5s, 2.0));
  bench.run_until(kAirborne + 6s);
  EXPECT_EQ(bench.mode_at(kAirborne + 1s), Mode::kIndoorNavigation);
  EXPECT_EQ(bench.mode_at(kAirborne + 3900ms), Mode::kHover);
  EXPECT_EQ(bench.mode_at(kAirborne + 4900ms), Mode::kHover);
  EXPECT_EQ(bench.mode_at(kAirborne + 5900ms), Mode::kIndoorNavigation);
  EXPECT_EQ(bench.missions().size(), 2u);
  ASSERT_EQ(bench.acks.size(), 5u);  // two are those of the take-off
  EXPECT_EQ(bench.acks[3], bench.acks[2]);
  EXPECT_NE(bench.acks[4].id(), bench.acks[3].id());
}

TEST(CommanderGoalPose, RepeatedWhileItIsFlownChangesNothing) {
  GoalBench bench;
  bench.take_off();
  bench.send(kAirborne, goal_pose(kAirborne, 2.0));
  bench.send(kAirborne + 300ms, goal_pose(kAirborne + 300ms, 2.0));
  bench.send(kAirborne + 600ms, goal_pose(Time{}, 2.0));
  bench.run_until(kAirborne + 1s);
  EXPECT_EQ(bench.missions().size(), 1u) << "the same place is the same mission";
}

TEST(CommanderGoalPose, WithoutAStampIsFlownAgainWhenItIsAskedForAgain) {
  GoalBench bench;
  bench.take_off();
  bench.send(Time(300ms), goal_pose(Time{}, 2.0));  // refused: on the ground
  bench.send(kAirborne, goal_pose(Time{}, 2.0));
  bench.send(kAirborne + 4s, goal_pose(Time{}, 2.0));
  bench.run_until(kAirborne + 5s);
  EXPECT_EQ(bench.missions().size(), 2u);
}

TEST(CommanderGoalPose, OnTheGroundIsRefusedAndTheStatusSaysWhy) {
  GoalBench bench;
  bench.send(Time(1s), goal_pose(Time(1s), 2.0));
  bench.run_until(Time(1500ms));
  EXPECT_THAT(bench.status.back().reason(), HasSubstr("navigate refused: on the ground"));
  ASSERT_EQ(bench.acks.size(), 1u);
  EXPECT_FALSE(bench.acks[0].accepted());
  EXPECT_TRUE(bench.goals.empty());
}

struct BadGoal {
  const char* name;
  void (*spoil)(PoseStamped& goal);
  const char* named;  // in the reason
};

class BadGoals : public ::testing::TestWithParam<BadGoal> {};

TEST_P(BadGoals, AreRefusedWithTheReasonInTheStatus) {
  GoalBench bench;
  bench.take_off();
  PoseStamped goal = goal_pose(kAirborne, 2.0);
  GetParam().spoil(goal);
  bench.send(kAirborne, goal);
  bench.send(kAirborne + 1s, goal_pose(kAirborne + 1s, 2.0));
  bench.run_until(kAirborne + 1500ms);
  EXPECT_EQ(bench.mode_at(kAirborne + 900ms), Mode::kHover);
  EXPECT_THAT(bench.status_at(kAirborne + 900ms).reason(), HasSubstr(GetParam().named));
  EXPECT_EQ(bench.mode_at(kAirborne + 1500ms), Mode::kIndoorNavigation) << "the next is flown";
  EXPECT_EQ(bench.status.back().reason(), "mission requested");
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

INSTANTIATE_TEST_SUITE_P(
    All, BadGoals,
    ::testing::Values(
        BadGoal{"Frame", [](PoseStamped& g) { g.header().frame_id("odom"); }, "frame 'odom'"},
        BadGoal{"NanPlace", [](PoseStamped& g) { g.pose().position().x(kNan); }, "no number"},
        BadGoal{"NanHeight", [](PoseStamped& g) { g.pose().position().z(kNan); }, "no number"},
        BadGoal{"Endless", [](PoseStamped& g) { g.pose().position().y(kInfinity); }, "no number"},
        BadGoal{"TooFar", [](PoseStamped& g) { g.pose().position().y(1e9); }, "is not a place"},
        BadGoal{"NanHeading", [](PoseStamped& g) { g.pose().orientation().w(kNan); }, "no number"},
        BadGoal{"NoRotation", [](PoseStamped& g) { g.pose().orientation({}); },
                "no unit quaternion"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(CommanderGoalPose, WithoutAFrameIsInTheMap) {
  GoalBench bench;
  bench.take_off();
  PoseStamped goal = goal_pose(kAirborne, 2.0);
  goal.header().frame_id("");
  bench.send(kAirborne, goal);
  bench.run_until(kAirborne + 500ms);
  EXPECT_EQ(bench.mode_at(kAirborne + 500ms), Mode::kIndoorNavigation);
}

}  // namespace
}  // namespace swiftlet::test
