// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/map_joiner.hpp"

#include <gtest/gtest.h>

#include "tests/perception/slam/drive.hpp"

namespace swiftlet::test {
namespace {

SlamGraph graph_of(const Drive& drive) {
  return {drive.slam.keyframes(), drive.slam.poses(), drive.slam.constraints()};
}

/// A map of the whole floor, and one of a part of it, driven the other way from another start.
struct TwoDrives {
  Drive whole{1}, part{2};
  TwoDrives() {
    whole.along(way_around(1.1));
    part.along(way_along({{20.0, 12.5}, {22.3, 12.5}, {22.3, 1.5}, {12.0, 1.4}}, 0.4));
  }
  /// T_whole_part, in truth.
  Pose2 frame() const { return whole.truth.front().inverse() * part.truth.front(); }
};

void expect_near(const Pose2& a, const Pose2& b, double distance, double angle) {
  EXPECT_LT((a.position - b.position).norm(), distance);
  EXPECT_LT(std::abs(wrap_angle(a.yaw - b.yaw)), angle);
}

/// Distances of poses to the truth, where the first keyframes are those of `whole` [m].
double mean_error(const std::vector<Pose2>& poses, const SlamGraph& graph,
                  const TwoDrives& drives) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const bool of_whole = i < drives.whole.slam.keyframes().size();
    const Drive& drive = of_whole ? drives.whole : drives.part;
    const double seconds = to_seconds(graph.keyframes[i]->time - Time{});
    const auto scan = static_cast<std::size_t>(std::lround(seconds * kRate_hz));
    const Pose2 truth = drives.whole.truth.front().inverse() * drive.truth.at(scan);
    errors.push_back((poses[i].position - truth.position).norm());
  }
  return mean(errors);
}

TEST(FindFrame, APartIsFoundInTheWholeWhateverItsFrame) {
  const TwoDrives drives;
  const auto frame = find_frame(graph_of(drives.whole), graph_of(drives.part));
  ASSERT_TRUE(frame);
  // At the start of the part: its drift comes on top.
  expect_near(*frame, drives.frame(), 0.25, 0.05);
}

TEST(FindFrame, WhatWasNeverSeenIsNotFound) {
  const TwoDrives drives;
  FloorPlan elsewhere;
  elsewhere.add_box({0, 0}, {13, 9});
  elsewhere.add_box({2.0, 3.0}, {4.5, 5.0});
  elsewhere.add_box({7.0, 0.0}, {7.3, 4.0});
  elsewhere.add_box({9.0, 6.0}, {10.0, 9.0});
  Drive other(3, elsewhere);
  other.along(way_along({{1.2, 1.0}, {6.0, 1.5}, {6.0, 6.0}, {11.5, 5.0}}, 0.0));
  EXPECT_FALSE(find_frame(graph_of(drives.whole), graph_of(other)));
  EXPECT_FALSE(find_frame({}, graph_of(other)));
  EXPECT_FALSE(find_frame(graph_of(other), {}));
}

TEST(FindFrame, OnePlaceIsEnoughWhereItIsKnownRoughly) {
  const TwoDrives drives;
  Drive brief(4);
  brief.along({{{9.0, 1.6}, 0.3}});
  const Pose2 truth = drives.whole.truth.front().inverse() * brief.truth.front();
  const Pose2 guess{truth.position + Eigen::Vector2d(0.4, -0.3), truth.yaw + 0.2};
  const auto frame = refine_frame(graph_of(drives.whole), graph_of(brief), guess, 1.0, 0.4);
  ASSERT_TRUE(frame);
  expect_near(*frame, truth, 0.08, 0.02);
  EXPECT_FALSE(find_frame(graph_of(drives.whole), graph_of(brief))) << "one place convinced";
}

TEST(JoinMaps, PutsBothWhereTheyAre) {
  const TwoDrives drives;
  const SlamGraph whole = graph_of(drives.whole), part = graph_of(drives.part);
  const auto frame = find_frame(whole, part);
  ASSERT_TRUE(frame);
  const SlamGraph joined = join_maps(whole, part, *frame);
  ASSERT_EQ(joined.size(), whole.size() + part.size());
  EXPECT_EQ(joined.poses.front().vector(), whole.poses.front().vector());
  EXPECT_GT(joined.constraints.size(), whole.constraints.size() + part.constraints.size() + 20);
  EXPECT_LT(mean_error(joined.poses, joined, drives), 0.04);
}

TEST(LidarSlamInAMap, GoesOnInTheJoinedOne) {
  TwoDrives drives;
  const SlamGraph whole = graph_of(drives.whole), part = graph_of(drives.part);
  const auto frame = find_frame(whole, part);
  ASSERT_TRUE(frame);
  const SlamGraph joined = join_maps(whole, part, *frame);
  // The join took its time: it went on meanwhile.
  drives.part.along(way_along({{12.0, 1.4}, {8.0, 1.5}}, M_PI));
  drives.part.slam.enter(joined, part.size());
  const auto& slam = drives.part.slam;
  ASSERT_GT(slam.keyframes().size(), static_cast<std::size_t>(joined.size()));
  drives.part.along(way_along({{8.0, 1.5}, {2.0, 1.4}}, M_PI));
  EXPECT_EQ(drives.part.lost, 0);
  EXPECT_LT(mean_error(slam.poses(), graph_of(drives.part), drives), 0.05);
}

TEST(LidarSlamInAMap, FindsItselfInItAndLeavesItAsItIs) {
  TwoDrives drives;
  const SlamGraph whole = graph_of(drives.whole);
  const auto frame = find_frame(whole, graph_of(drives.part));
  ASSERT_TRUE(frame);
  drives.part.slam.stay_in(whole, *frame);
  const std::size_t before = drives.part.truth.size();
  drives.part.along(way_along({{12.0, 1.4}, {1.6, 1.5}, {1.5, 9.0}}, M_PI));
  EXPECT_EQ(drives.part.slam.keyframes().size(), whole.keyframes.size());
  EXPECT_FALSE(drives.part.slam.has_job());
  EXPECT_EQ(drives.part.lost, 0);
  std::vector<double> errors;
  for (std::size_t i = before; i < drives.part.truth.size(); ++i) {
    const Pose2 truth = drives.whole.truth.front().inverse() * drives.part.truth[i];
    errors.push_back((drives.part.live[i].position - truth.position).norm());
  }
  EXPECT_LT(mean(errors), 0.03);
  EXPECT_LT(largest(errors), 0.10);
  EXPECT_EQ(drives.part.slam.trajectory().size(), drives.part.truth.size());
}

}  // namespace
}  // namespace swiftlet::test
