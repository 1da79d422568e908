// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>
#include <map>
#include <optional>
#include <utility>

#include "components/conversions.hpp"
#include "components/lidar_mapper/grid_message.hpp"
#include "estimation/geometry/pose2.hpp"
#include "estimation/geometry/so3.hpp"
#include "swiftlet_msgs.h"
#include "tests/system/recorded.hpp"
#include "tests/system/system_test.hpp"

namespace swiftlet::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

Pose2 planar(const geometry_msgs::msg::Pose& pose) {
  return {{pose.position().x(), pose.position().y()}, yaw_of(from_msg(pose.orientation()))};
}

class Flight : public SystemTest {
 protected:
  struct Result {
    Finished finished;
    json report;
  };

  /// A flight that is under way. Its recording is <name>.mcap.
  Process depart(const std::string& scenario, const std::string& name, int seed) {
    return start({"--log", "warning", "fly", scenario, "--record", path(name + ".mcap"), "--report",
                  path(name), "--seed", std::to_string(seed)});
  }
  Result arrive(Process process, const std::string& name) {
    const auto finished = process.wait(kFlightLimit);
    EXPECT_TRUE(finished) << name << " does not end";
    return {finished.value_or(Finished{-1, process.out(), process.err(), {}}),
            read_report(folder() / name)};
  }
  Result fly(const std::string& scenario, const std::string& name, int seed) {
    return arrive(depart(scenario, name, seed), name);
  }

  static void expect_flown(const Result& result) {
    EXPECT_EQ(result.finished.exit_code, 0) << result.finished.out << result.finished.err;
    ASSERT_FALSE(result.report.is_null());
    EXPECT_EQ(result.report["success"], true);
    EXPECT_EQ(result.report["contacts"], 0);
    EXPECT_THAT(result.report["bag_hash"].dump(), testing::MatchesRegex("\"[0-9a-f]{16}\""));
  }
};

TEST_F(Flight, TheUnknownHouseIsExploredRoomByRoom) {
  const Result result = fly(house(), "house", 1);
  expect_flown(result);
  EXPECT_GE(result.report["min_clearance_m"].get<double>(), 0.10);
  EXPECT_LE(result.report["landing_error_m"].get<double>(), 0.10);
  const auto map =
      from_msg(last_message<nav_msgs::msg::OccupancyGrid>(path("house.mcap"), "map"), {});
  // From components/sim/worlds/house.sdf, with nothing on the floor there or near it.
  const Eigen::Vector2d places[] = {{0.6, 3.6},  {5.0, 0.5},  {5.9, 3.8},  {8.7, 1.5},
                                    {9.5, 3.8},  {13.3, 0.4}, {0.6, 6.4},  {2.0, 9.6},
                                    {6.6, 9.6},  {4.9, 6.3},  {7.3, 9.6},  {10.1, 6.3},
                                    {10.9, 9.6}, {13.6, 6.3}, {13.6, 5.0}, {0.4, 4.6}};
  for (const Eigen::Vector2d& place : places) {
    EXPECT_EQ(map.state(map.cell_of(place)), CellState::kFree) << place.transpose();
  }
}

TEST_F(Flight, TheOfficeIsFlownWithinItsGoals) {
  const Result result = fly(office(), "office", 1);
  expect_flown(result);
  EXPECT_GE(result.report["min_clearance_m"].get<double>(), 0.10);
  EXPECT_LE(result.report["landing_error_m"].get<double>(), 0.10);
  for (const json& rmse : result.report["position_rmse_m"]) EXPECT_LE(rmse.get<double>(), 0.06);
  const auto status =
      last_message<swiftlet_msgs::msg::VehicleStatus>(path("office.mcap"), "vehicle/status");
  EXPECT_EQ(status.mode(), swiftlet_msgs::msg::VehicleStatus_Constants::GROUNDED);
  EXPECT_FALSE(status.armed());
  for (const char* file : {"flight.png", "map.pgm", "map.yaml", "map.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder() / "office" / file)) << file;
  }
  EXPECT_EQ(run({"bag", "verify", path("office.mcap")}).exit_code, 0);
}

TEST_F(Flight, InTheMapOfAMapperThatFindsItsPosesItself) {
  Process process = start({"--log", "warning", "fly", office(), "--param", "lidar_mapper.slam=true",
                           "--record", path("slam.mcap"), "--report", path("slam")});
  expect_flown(arrive(std::move(process), "slam"));
  const auto topics = read_topics(path("slam.mcap"));
  std::map<std::int64_t, Pose2> truth;
  for (const mcap::Bytes& bytes : topics.at("sim/truth")) {
    const auto message = from_cdr<swiftlet_msgs::msg::SimTruth>(bytes).value();
    truth[from_msg(message.header().stamp()).time_since_epoch().count()] = planar(message.pose());
  }
  std::optional<Pose2> T_truth_slam;
  double worst = 0.0;
  std::size_t compared = 0;
  for (const mcap::Bytes& bytes : topics.at("lidar/pose")) {
    const auto message = from_cdr<geometry_msgs::msg::PoseWithCovarianceStamped>(bytes).value();
    const auto there = truth.find(from_msg(message.header().stamp()).time_since_epoch().count());
    if (there == truth.end()) continue;
    const Pose2 found = planar(message.pose().pose());
    if (!T_truth_slam) T_truth_slam = there->second * found.inverse();
    worst = std::max(worst, ((*T_truth_slam * found).position - there->second.position).norm());
    ++compared;
  }
  EXPECT_GT(compared, 600U);
  EXPECT_LT(worst, 0.10);
}

TEST_F(Flight, TheSameSeedGivesTheSameMessagesAndAnotherSeedOthers) {
  // Beside each other, so that the scheduler does not do the same to both.
  Process first = depart(office(), "first", 7);
  Process second = depart(office(), "second", 7);
  const Result a = arrive(std::move(first), "first");
  const Result b = arrive(std::move(second), "second");
  const Result other = fly(office(), "other", 8);
  for (const Result& result : {a, b, other}) expect_flown(result);
  EXPECT_EQ(a.report["bag_hash"], b.report["bag_hash"]);
  EXPECT_NE(a.report["bag_hash"], other.report["bag_hash"]);
  // The hash is of the recording that is there: what it claims, the messages must show.
  EXPECT_EQ(read_topics(path("first.mcap")), read_topics(path("second.mcap")));
  EXPECT_NE(read_topics(path("first.mcap")), read_topics(path("other.mcap")));
}

TEST_F(Flight, TwoBesideEachOtherFlyAsEachDoesAlone) {
  const Result alone = fly(hop(), "alone", 3);
  const Result alone_too = fly(hop(), "alone_too", 4);
  Process first = depart(hop(), "first", 3);
  Process second = depart(hop(), "second", 4);
  const Result a = arrive(std::move(first), "first");
  const Result b = arrive(std::move(second), "second");
  for (const Result& result : {alone, alone_too, a, b}) expect_flown(result);
  EXPECT_EQ(alone.report["bag_hash"], a.report["bag_hash"]);
  EXPECT_EQ(alone_too.report["bag_hash"], b.report["bag_hash"]);
  EXPECT_NE(alone.report["bag_hash"], alone_too.report["bag_hash"]);
}

TEST_F(Flight, IsNotDisturbedByALiveVehicleInItsDomain) {
  const Result alone = fly(hop(), "alone", 3);
  Process sim = start({"run", "sim", "commander", "--scenario", hop()});
  ASSERT_TRUE(becomes_true(kStartLimit, [&] {
    return run({"gcs", "status"}).exit_code == 0;
  })) << sim.err();
  const Result beside = fly(hop(), "beside", 3);
  expect_flown(beside);
  EXPECT_EQ(alone.report["bag_hash"], beside.report["bag_hash"]);
  expect_end(sim, SIGTERM, 0);
}

TEST_F(Flight, BehindAClosedDoorEndsInHoverWithTheReason) {
  const Result result = fly(closed_door(), "closed", 1);
  EXPECT_EQ(result.finished.exit_code, 1);
  ASSERT_FALSE(result.report.is_null()) << result.finished.err;
  EXPECT_EQ(result.report["success"], false);
  EXPECT_THAT(result.report["reason"].get<std::string>(), HasSubstr("no path to waypoint 2"));
  EXPECT_THAT(result.finished.out, HasSubstr("no path to waypoint 2"));
  EXPECT_EQ(result.report["contacts"], 0);
  const auto status =
      last_message<swiftlet_msgs::msg::VehicleStatus>(path("closed.mcap"), "vehicle/status");
  EXPECT_EQ(status.mode(), swiftlet_msgs::msg::VehicleStatus_Constants::HOVER);
  EXPECT_EQ(status.waypoint(), 2U);
  const auto truth = last_message<swiftlet_msgs::msg::SimTruth>(path("closed.mcap"), "sim/truth");
  EXPECT_EQ(truth.contacts(), 0U);
  EXPECT_FALSE(truth.on_ground());
}

TEST_F(Flight, AnEstimatorThatDiesInTheClimbLeavesTheWallsAlone) {
  const int seeds = full_tests() ? 24 : kSlowdown > 1 ? 1 : 6;
  for (int seed = 1; seed <= seeds; ++seed) {
    for (const char* fault : {"kill estimator@11.2", "kill estimator@12"}) {
      SCOPED_TRACE(fault + std::string(", seed ") + std::to_string(seed));
      const Finished finished = run({"--log", "warning", "fly", office(), "--report", path("blind"),
                                     "--seed", std::to_string(seed), "--what-if", fault});
      EXPECT_EQ(finished.exit_code, 1);
      const json report = read_report(folder() / "blind");
      ASSERT_FALSE(report.is_null()) << finished.err;
      EXPECT_EQ(report["contacts"], 0);
      EXPECT_THAT(report["reason"].get<std::string>(), HasSubstr("no odometry for"));
      EXPECT_GT(report["flight_time_s"], 1.0) << "did not take off before";
    }
  }
}

TEST_F(Flight, EverySeedCompletesTheOffice) {
  const int seeds = full_tests() ? 50 : kSlowdown > 1 ? 1 : 3;
  std::vector<std::pair<std::string, Process>> under_way;
  const auto land_one = [&] {
    auto [name, process] = std::move(under_way.front());
    under_way.erase(under_way.begin());
    const Result result = arrive(std::move(process), name);
    SCOPED_TRACE(name);
    expect_flown(result);
    std::filesystem::remove(path(name + ".mcap"));
  };
  for (int seed = 1; seed <= seeds; ++seed) {
    if (under_way.size() == 2) land_one();
    const std::string name = "seed_" + std::to_string(seed);
    under_way.emplace_back(name, depart(office(), name, seed));
  }
  while (!under_way.empty()) land_one();
}

}  // namespace
}  // namespace swiftlet::test
