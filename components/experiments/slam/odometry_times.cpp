// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/slam/odometry_times.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <tuple>

namespace swiftlet {
namespace {

constexpr double kTick = 0.0125;            // of the clock of loggers, and a little [s]
constexpr std::ptrdiff_t kNeighbours = 15;  // to either side
constexpr double kLeastForALine = 3.0;
constexpr double kFastest = 60.0;  // [m/s]

struct Line {
  double t = 0.0;  // as stamped [s]
  std::size_t line = 0;
  Pose2 pose;
  bool is_scan = false;
  bool waited = false;
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
    lines[i].waited = lines[i].t - lines[i - 1].t < kTick;
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
    if (line.waited) continue;
    const double x = static_cast<double>(i - place), t = line.t - stamped;
    n += 1.0, sx += x, st += t, sxx += x * x, sxt += x * t;
  }
  const double spread = n * sxx - sx * sx;
  if (n < kLeastForALine || !(spread > 0.0)) return stamped;
  return std::min(stamped, stamped + (st * sxx - sx * sxt) / spread);
}

/// Takes lines between scans back in time, as far as the scan before, until none is left in a
/// hurry.
void slow_down(std::vector<Line>& lines) {
  std::vector<double> earliest;
  double last_scan = -std::numeric_limits<double>::infinity();
  for (const Line& line : lines) {
    earliest.push_back(last_scan);
    if (line.is_scan) last_scan = line.t;
  }
  for (std::size_t i = lines.size(); i-- > 1;) {
    Line& before = lines[i - 1];
    if (before.is_scan) continue;
    const double least = (lines[i].pose.position - before.pose.position).norm() / kFastest;
    before.t = std::min(before.t, std::max(earliest[i - 1], lines[i].t - least));
  }
}

}  // namespace

std::vector<TimedPose2> timed_odometry(const carmen::Log& log) {
  std::vector<Line> lines = lines_of(log);
  std::vector<double> times;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool retimed = lines[i].waited && !lines[i].is_scan;
    times.push_back(retimed ? steady_time(lines, static_cast<std::ptrdiff_t>(i)) : lines[i].t);
  }
  for (std::size_t i = 0; i < lines.size(); ++i) lines[i].t = times[i];
  std::stable_sort(lines.begin(), lines.end(),
                   [](const Line& a, const Line& b) { return a.t < b.t; });
  slow_down(lines);
  std::vector<TimedPose2> odometry;
  odometry.reserve(lines.size());
  for (const Line& line : lines) odometry.push_back({line.t, line.pose});
  return odometry;
}

}  // namespace swiftlet
