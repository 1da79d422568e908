// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/odometry_times.hpp"

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace swiftlet {
namespace {

constexpr double kPushed = 0.0015;          // after the line before, at most [s]
constexpr std::ptrdiff_t kNeighbours = 15;  // to either side
constexpr double kLeastForALine = 3.0;

struct Line {
  double t = 0.0;  // as stamped [s]
  std::size_t line = 0;
  Pose2 pose;
  bool is_scan = false;
  bool is_pushed = false;
};

Pose2 pose_of(const carmen::Pose& pose) {
  return {{pose.x, pose.y}, pose.theta};
}

std::vector<Line> lines_of(const carmen::Log& log) {
  std::vector<Line> lines;
  for (const carmen::Scan& scan : log.scans) {
    if (!scan.has_pose) continue;
    lines.push_back({to_seconds(scan.time), scan.line, pose_of(scan.robot_pose), true, false});
  }
  for (const carmen::Odometry& odometry : log.odometry) {
    lines.push_back(
        {to_seconds(odometry.time), odometry.line, pose_of(odometry.pose), false, false});
  }
  std::sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) {
    return std::tie(a.t, a.line) < std::tie(b.t, b.line);
  });
  for (std::size_t i = 1; i < lines.size(); ++i) {
    lines[i].is_pushed = lines[i].t - lines[i - 1].t < kPushed;
  }
  return lines;
}

/// By the least squares line of stamps over places, of those around that tell the time.
double steady_time(const std::vector<Line>& lines, std::ptrdiff_t place) {
  const auto last = static_cast<std::ptrdiff_t>(lines.size()) - 1;
  const double stamped = lines[static_cast<std::size_t>(place)].t;
  double n = 0.0, sx = 0.0, st = 0.0, sxx = 0.0, sxt = 0.0;
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, place - kNeighbours);
       i <= std::min(last, place + kNeighbours); ++i) {
    const Line& line = lines[static_cast<std::size_t>(i)];
    if (line.is_pushed) continue;
    const double x = static_cast<double>(i - place), t = line.t - stamped;
    n += 1.0, sx += x, st += t, sxx += x * x, sxt += x * t;
  }
  const double spread = n * sxx - sx * sx;
  if (n < kLeastForALine || !(spread > 0.0)) return stamped;
  return std::min(stamped, stamped + (st * sxx - sx * sxt) / spread);
}

}  // namespace

std::vector<TimedPose2> timed_odometry(const carmen::Log& log) {
  const std::vector<Line> lines = lines_of(log);
  std::vector<TimedPose2> odometry;
  odometry.reserve(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool retimed = lines[i].is_pushed && !lines[i].is_scan;
    const double t = retimed ? steady_time(lines, static_cast<std::ptrdiff_t>(i)) : lines[i].t;
    odometry.push_back({t, lines[i].pose});
  }
  std::stable_sort(odometry.begin(), odometry.end(),
                   [](const TimedPose2& a, const TimedPose2& b) { return a.t < b.t; });
  return odometry;
}

}  // namespace swiftlet
