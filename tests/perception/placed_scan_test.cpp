// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/placed_scan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Time kBegin(100s);
const Eigen::Vector3d kVelocity(1.5, -0.7, 0.4);
constexpr double kYawRate = 2.0;  // [rad/s]

/// A body that flies and turns while it scans.
PoseHistory::Pose body_at(Time time) {
  const double t = to_seconds(time - kBegin);
  const Eigen::Quaterniond tilt(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()));
  const Eigen::Quaterniond yaw(Eigen::AngleAxisd(0.3 + kYawRate * t, Eigen::Vector3d::UnitZ()));
  return {Eigen::Vector3d(0.5, 0.2, 1.2) + kVelocity * t, yaw * tilt};
}
PoseHistory::Pose mount() {
  return {{0.05, -0.02, 0.08},
          Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()))};
}
PoseHistory flight(Duration period) {
  PoseHistory history(10s);
  for (Time time = kBegin - 100ms; time < kBegin + 1s; time += period) {
    history.add(time, body_at(time));
  }
  return history;
}

/// How far it is along a ray to the walls of a room of 8 x 6 m around the origin.
double to_wall(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  const double x = ((direction.x() > 0 ? 4.0 : -4.0) - from.x()) / direction.x();
  const double y = ((direction.y() > 0 ? 3.0 : -3.0) - from.y()) / direction.y();
  return std::min(x, y);
}

/// What the scanner measures, one beam after the other, and where each beam ended.
LaserScan scan_of_room(std::vector<Eigen::Vector3d>& hits) {
  LaserScan scan;
  scan.angle_min = -M_PI;
  scan.angle_increment = 2.0 * M_PI / 360.0;
  scan.time_increment = 0.1 / 360.0;
  scan.range_min = 0.1;
  scan.range_max = 20.0;
  for (int i = 0; i < 360; ++i) {
    const PoseHistory::Pose body = body_at(kBegin + i * from_seconds(scan.time_increment));
    const Eigen::Vector3d from = body.position + body.attitude * mount().position;
    const double angle = scan.angle_min + i * scan.angle_increment;
    const Eigen::Vector3d direction =
        body.attitude * mount().attitude * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
    const double range = to_wall(from, direction);
    scan.ranges.push_back(static_cast<float>(range));
    hits.emplace_back(from + range * direction);
  }
  return scan;
}

TEST(PlacedReturns, AreWhereTheBeamsEndedThoughTheScannerFliesAndTurns) {
  std::vector<Eigen::Vector3d> hits;
  const LaserScan scan = scan_of_room(hits);
  const auto points = placed_returns(scan, kBegin, flight(5ms), mount(), 20ms);
  ASSERT_EQ(points.size(), hits.size());
  double worst_of_one_pose = 0.0;
  PoseHistory stands(10s);
  stands.add(kBegin - 1s, body_at(kBegin));
  stands.add(kBegin + 1s, body_at(kBegin));
  const auto frozen = placed_returns(scan, kBegin, stands, mount(), 10s);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LT((points[i] - hits[i]).norm(), 1e-3) << "beam " << i;
    worst_of_one_pose = std::max(worst_of_one_pose, (frozen[i] - hits[i]).norm());
  }
  EXPECT_GT(worst_of_one_pose, 0.3) << "so that one pose a scan would not do";
}

TEST(PlacedReturns, LeaveOutWhatIsNoReturnAndWhatHasNoPose) {
  std::vector<Eigen::Vector3d> hits;
  LaserScan scan = scan_of_room(hits);
  scan.ranges[10] = std::numeric_limits<float>::quiet_NaN();
  scan.ranges[11] = std::numeric_limits<float>::infinity();
  scan.ranges[12] = 0.05F;
  scan.ranges[13] = 20.0F;
  EXPECT_EQ(placed_returns(scan, kBegin, flight(5ms), mount(), 20ms).size(), 356u);
  // Poses end in the middle of the turn.
  PoseHistory half(10s);
  half.add(kBegin, body_at(kBegin));
  half.add(kBegin + 50ms, body_at(kBegin + 50ms));
  const std::size_t seen = placed_returns(scan, kBegin, half, mount(), 100ms).size();
  EXPECT_NEAR(static_cast<double>(seen), 181.0 - 4.0, 1.0);
  EXPECT_TRUE(placed_returns(scan, kBegin, half, mount(), 20ms).size() <= 1u) << "too far apart";
  EXPECT_TRUE(placed_returns(scan, kBegin, PoseHistory(1s), mount(), 1s).empty());
}

TEST(EndOfScan, IsTheLastBeamsTimeAndBelievesNoNonsense) {
  LaserScan scan;
  EXPECT_EQ(end_of(scan, kBegin), kBegin);
  scan.ranges.assign(101, 1.0F);
  scan.time_increment = 0.001;
  EXPECT_EQ(end_of(scan, kBegin), kBegin + 100ms);
  for (const double nonsense : {-0.001, 1e6, std::nan(""), 0.0}) {
    scan.time_increment = nonsense;
    EXPECT_EQ(end_of(scan, kBegin), kBegin) << nonsense;
  }
}

}  // namespace
}  // namespace swiftlet
