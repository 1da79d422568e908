// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The real commander and planner on real Fast DDS, in lockstep: acknowledgements and answers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "components/commander/mission_message.hpp"
#include "components/lidar_mapper/grid_message.hpp"
#include "components/planner/trajectory_message.hpp"
#include "tests/components/component_bench.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using namespace std::chrono_literals;
using swiftlet_msgs::msg::CommandAck;
using swiftlet_msgs::msg::MotorCommand;
using swiftlet_msgs::msg::VehicleStatus;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Answer = swiftlet_msgs::msg::Trajectory;
namespace command = swiftlet_msgs::msg::ModeCommand_Constants;
namespace setpoint_kind = swiftlet_msgs::msg::Setpoint_Constants;
namespace answers = swiftlet_msgs::msg::Trajectory_Constants;

// --- commander -----------------------------------------------------------------------------

/// A vehicle that is ready, on the ground.
struct CommanderBench : Bench {
  std::vector<CommandAck>& acks;
  std::vector<VehicleStatus>& status;
  std::shared_ptr<Publisher<swiftlet_msgs::msg::ModeCommand>> mode;
  std::shared_ptr<Publisher<swiftlet_msgs::msg::Mission>> mission;

  CommanderBench()
      : Bench("commander", "settling_to_arm: 0"),
        acks(record(topic::mode_ack)),
        status(record(topic::vehicle_status)) {
    send_odometry({0, 0, 0});
    every(topic::range_down, 50ms, Time{}, [](Time) {
      sensor_msgs::msg::Range range;
      range.range(0.15f);
      return range;
    });
    send_motors();
    mode =
        std::make_shared<Publisher<swiftlet_msgs::msg::ModeCommand>>(probe.advertise(topic::mode));
    mission =
        std::make_shared<Publisher<swiftlet_msgs::msg::Mission>>(probe.advertise(topic::waypoints));
  }

  void ask(Time time, const std::string& id, std::uint8_t what, double altitude = 0.0) {
    at(time, mode, [=](Time now) {
      swiftlet_msgs::msg::ModeCommand message;
      message.header(make_header(now, frame::kMap));
      message.id(id);
      message.command(what);
      message.altitude(altitude);
      return message;
    });
  }
};

TEST(CommanderComponent, CarriesACommandOutOnceAndRepeatsItsAck) {
  CommanderBench bench;
  bench.ask(Time(500ms), "take-off too early", command::TAKEOFF, 1.0);
  bench.ask(Time(600ms), "arm", command::ARM);
  bench.ask(Time(700ms), "arm", command::ARM);
  bench.ask(Time(800ms), "disarm", command::DISARM);
  // The same id is the same command: it arms no more, and the take-off stays refused.
  bench.ask(Time(900ms), "arm", command::ARM);
  bench.ask(Time(1000ms), "arm again", command::ARM);
  bench.ask(Time(1100ms), "take-off too early", command::TAKEOFF, 1.0);
  bench.run_until(Time(1200ms));

  std::vector<std::string> ids;
  for (const CommandAck& ack : bench.acks) ids.push_back(ack.id());
  ASSERT_THAT(ids, ElementsAre("take-off too early", "arm", "arm", "disarm", "arm", "arm again",
                               "take-off too early"));
  EXPECT_FALSE(bench.acks[0].accepted());
  EXPECT_EQ(bench.acks[0].reason(), "takeoff refused: not armed; send arm first");
  EXPECT_EQ(bench.acks[6], bench.acks[0]);
  for (const int i : {1, 3, 5}) {
    EXPECT_TRUE(bench.acks[static_cast<std::size_t>(i)].accepted());
    EXPECT_EQ(bench.acks[static_cast<std::size_t>(i)].reason(), "");
  }
  EXPECT_EQ(bench.acks[2], bench.acks[1]);
  EXPECT_EQ(bench.acks[4], bench.acks[1]);
  const auto armed_at = [&](Time time) {
    bool armed = false;
    for (const VehicleStatus& s : bench.status) {
      if (from_msg(s.header().stamp()) <= time) armed = s.armed();
    }
    return armed;
  };
  EXPECT_FALSE(armed_at(Time(590ms)));
  EXPECT_TRUE(armed_at(Time(790ms)));
  EXPECT_FALSE(armed_at(Time(990ms)));
  EXPECT_TRUE(armed_at(Time(1200ms)));
}

TEST(CommanderComponent, AnswersWithinTheSameMomentAndRefusesWhatItDoesNotKnow) {
  CommanderBench bench;
  bench.ask(Time(503ms), "c1", 99);
  bench.run_until(Time(600ms));
  ASSERT_EQ(bench.acks.size(), 1u);
  EXPECT_EQ(from_msg(bench.acks[0].header().stamp()), Time(503ms));
  EXPECT_FALSE(bench.acks[0].accepted());
  EXPECT_EQ(bench.acks[0].reason(), "there is no command 99");
}

TEST(CommanderComponent, RefusesAMissionThatWasDamagedOnTheWay) {
  CommanderBench bench;
  const std::vector<MissionWaypoint> waypoints{{{1, 2, 1}, {}}};
  bench.at(Time(500ms), bench.mission, [=](Time now) {
    auto mission = make_mission(now, "damaged", waypoints);
    mission.waypoints()[0].position().x(1.5);
    return mission;
  });
  bench.at(Time(600ms), bench.mission,
           [=](Time now) { return make_mission(now, "sound", waypoints); });
  bench.run_until(Time(700ms));
  ASSERT_EQ(bench.acks.size(), 2u);
  EXPECT_EQ(bench.acks[0].id(), "damaged");
  EXPECT_FALSE(bench.acks[0].accepted());
  EXPECT_THAT(bench.acks[0].reason(), HasSubstr("checksum is wrong"));
  EXPECT_EQ(bench.acks[1].id(), "sound");
  EXPECT_THAT(bench.acks[1].reason(), HasSubstr("on the ground")) << "refused for another reason";
}

TEST(CommanderComponent, SetsMotorsOffAHundredTimesASecondOnTheGround) {
  CommanderBench bench;
  auto& setpoints = bench.record(topic::setpoint);
  bench.run_until(Time(1s));
  EXPECT_NEAR(static_cast<double>(setpoints.size()), 100, 1);
  for (const auto& setpoint : setpoints) EXPECT_EQ(setpoint.kind(), setpoint_kind::MOTORS_OFF);
  EXPECT_TRUE(bench.status.back().ready());
}

TEST(CommanderComponent, AVehicleThatDoesNotClimbIsSetDownAgain) {
  CommanderBench bench;
  bench.ask(Time(500ms), "arm", command::ARM);
  bench.ask(Time(600ms), "takeoff", command::TAKEOFF, 1.0);
  auto& setpoints = bench.record(topic::setpoint);
  bench.run_until(Time(10s));
  ASSERT_EQ(bench.acks.size(), 2u);
  EXPECT_TRUE(bench.acks[1].accepted()) << bench.acks[1].reason();
  double highest = 0.0;
  for (const auto& setpoint : setpoints) highest = std::max(highest, setpoint.position().z());
  EXPECT_NEAR(highest, 1.0, 1e-6);
  EXPECT_EQ(setpoints.back().kind(), setpoint_kind::MOTORS_OFF);
  EXPECT_FALSE(bench.status.back().armed());
  EXPECT_EQ(bench.status.back().reason(), "landed");
}

// --- planner -------------------------------------------------------------------------------

/// A vehicle that hovers at the origin of a room of 10 m by 10 m.
struct PlannerBench : Bench {
  std::vector<Answer>& heard;
  static constexpr Time kGoalTime{Duration(1'234'567'890)};

  PlannerBench() : Bench("planner"), heard(record(topic::trajectory)) {
    send_odometry({0, 0, 1.2});
    every(topic::setpoint, 10ms, Time{}, [](Time now) {
      swiftlet_msgs::msg::Setpoint setpoint;
      setpoint.header(make_header(now, frame::kMap));
      setpoint.kind(setpoint_kind::TRACK);
      setpoint.position(to_point({0, 0, 1.2}));
      return setpoint;
    });
  }

  /// Free, with walls around; and around the goal too, if asked for.
  void send_map(bool goal_walled_in, Time time = Time(100ms)) {
    OccupancyGrid grid({}, Vector2d(-5, -5), 200, 200);
    for (int y = 0; y < 200; ++y) {
      for (int x = 0; x < 200; ++x) {
        const Vector2d p = grid.center_of({x, y});
        const double from_goal = (p - Vector2d(3, 3)).lpNorm<Eigen::Infinity>();
        const bool wall = p.lpNorm<Eigen::Infinity>() > 4.8 ||
                          (goal_walled_in && from_goal > 1.0 && from_goal < 1.2);
        grid.set_state({x, y}, wall ? CellState::kOccupied : CellState::kFree);
      }
    }
    const auto map =
        std::make_shared<Publisher<nav_msgs::msg::OccupancyGrid>>(probe.advertise(topic::map));
    at(time, map, [grid](Time now) { return to_msg(grid, now); });
  }

  void send_goal(const Vector3d& position, Time until) {
    every(
        topic::goal, 100ms, Time(500ms),
        [position](Time) {
          geometry_msgs::msg::PoseStamped goal;
          goal.header(make_header(kGoalTime, frame::kMap));
          goal.pose(to_pose(position, Eigen::Quaterniond::Identity()));
          return goal;
        },
        until);
  }
};

TEST(PlannerComponent, LeadsFromTheReferenceToTheGoal) {
  PlannerBench bench;
  bench.send_map(false);
  bench.send_goal({3, 3, 1.2}, Time(700ms));
  bench.run_until(Time(800ms));
  ASSERT_FALSE(bench.heard.empty());
  const Answer& answer = bench.heard.front();
  EXPECT_EQ(answer.status(), answers::PLANNED) << answer.failure() << ": " << answer.reason();
  EXPECT_EQ(from_msg(answer.goal_stamp()), PlannerBench::kGoalTime);
  const Trajectory trajectory = from_msg(answer);
  ASSERT_FALSE(trajectory.empty());
  EXPECT_GE(trajectory.start(), Time(500ms));
  EXPECT_LT((trajectory.evaluate(trajectory.start()).position - Vector3d(0, 0, 1.2)).norm(), 1e-6);
  EXPECT_LT((trajectory.final_reference().position - Vector3d(3, 3, 1.2)).norm(), 1e-3);
}

TEST(PlannerComponent, AGoalWhereTheVehicleIsIsAnsweredTooAndOnce) {
  PlannerBench bench;
  bench.send_map(false);
  bench.send_goal({0, 0, 1.2}, Time(3s));
  bench.run_until(Time(3s));
  ASSERT_EQ(bench.heard.size(), 1u);
  EXPECT_EQ(bench.heard[0].status(), answers::PLANNED);
  EXPECT_EQ(from_msg(bench.heard[0].goal_stamp()), PlannerBench::kGoalTime);
  const Trajectory trajectory = from_msg(bench.heard[0]);
  EXPECT_EQ(trajectory.final_reference().position, Vector3d(0, 0, 1.2));
  EXPECT_LE(trajectory.end(), Time(600ms)) << "it is there";
}

TEST(PlannerComponent, AnswersAGoalThatItCannotReachWithAReason) {
  PlannerBench bench;
  bench.send_map(true);
  bench.send_goal({3, 3, 1.2}, Time(6s));
  bench.run_until(Time(6s));
  ASSERT_EQ(bench.heard.size(), 1u) << "answered once, not again and again";
  const Answer& answer = bench.heard[0];
  EXPECT_EQ(answer.status(), answers::FAILED);
  EXPECT_EQ(answer.failure(), "no path");
  EXPECT_NE(answer.reason(), "");
  EXPECT_EQ(from_msg(answer.goal_stamp()), PlannerBench::kGoalTime);
  EXPECT_LE(from_msg(answer.header().stamp()), Time(500ms) + 1s);
  EXPECT_THAT(answer.segments(), IsEmpty());
}

TEST(PlannerComponent, AMapWithoutCellsDoesNotReplaceOneThatWasGood) {
  PlannerBench bench;
  bench.send_map(false);
  const auto map =
      std::make_shared<Publisher<nav_msgs::msg::OccupancyGrid>>(bench.probe.advertise(topic::map));
  bench.at(Time(300ms), map, [](Time now) {
    nav_msgs::msg::OccupancyGrid empty;
    empty.header(make_header(now, frame::kMap));
    return empty;
  });
  bench.send_goal({3, 3, 1.2}, Time(2s));
  bench.run_until(Time(2s));
  ASSERT_FALSE(bench.heard.empty());
  EXPECT_EQ(bench.heard[0].status(), answers::PLANNED) << bench.heard[0].reason();
}

TEST(PlannerComponent, AGoalThatIsNoLongerSetIsNoLongerPlannedFor) {
  PlannerBench bench;
  bench.send_goal({3, 3, 1.2}, Time(650ms));
  bench.send_map(false, Time(2s));  // it could plan only now
  bench.run_until(Time(3s));
  EXPECT_THAT(bench.heard, IsEmpty());
}

}  // namespace
}  // namespace swiftlet::test
