// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/convert_carmen.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "components/bag/topic_file.hpp"
#include "nav_msgs.h"
#include "sensor_msgs.h"

namespace swiftlet {
namespace {

using carmen::Pose;

constexpr const char* kLaserFrame = "laser";

template <class Header>
void fill_header(Header& header, Time time, const std::string& frame) {
  const auto ns = time.time_since_epoch().count();
  constexpr std::int64_t kSecond = 1'000'000'000;
  header.stamp().sec(static_cast<std::int32_t>(ns / kSecond));
  header.stamp().nanosec(static_cast<std::uint32_t>(ns % kSecond));
  header.frame_id(frame);
}

sensor_msgs::msg::LaserScan to_message(const carmen::Scan& scan) {
  sensor_msgs::msg::LaserScan message;
  fill_header(message.header(), scan.time, kLaserFrame);
  const double beams = static_cast<double>(std::max<std::size_t>(scan.ranges.size(), 1));
  message.angle_min(static_cast<float>(scan.angle_min));
  message.angle_max(static_cast<float>(scan.angle_min + (beams - 1.0) * scan.angle_increment));
  message.angle_increment(static_cast<float>(scan.angle_increment));
  message.range_min(0.01F);  // CARMEN has none; a range of 0 is a beam that failed
  message.range_max(static_cast<float>(scan.max_range));
  message.ranges(scan.ranges);
  message.intensities(scan.intensities);
  return message;
}

nav_msgs::msg::Odometry to_message(Time time, const Pose& laser, double height,
                                   const std::string& frame) {
  nav_msgs::msg::Odometry message;
  fill_header(message.header(), time, frame);
  message.child_frame_id(kLaserFrame);
  message.pose().pose().position().x(laser.x);
  message.pose().pose().position().y(laser.y);
  message.pose().pose().position().z(height);
  message.pose().pose().orientation().z(std::sin(0.5 * laser.theta));
  message.pose().pose().orientation().w(std::cos(0.5 * laser.theta));
  return message;
}

/// A line of the log that becomes one or two messages; exactly one of the two is set.
struct Event {
  Time time;
  std::size_t line = 0;
  const carmen::Scan* scan = nullptr;
  const carmen::Odometry* odometry = nullptr;
};

/// In the order of time, lines of one time in that of the log. An ODOM line of the same time as a
/// scan is left out: the scan has a pose of its own.
std::vector<Event> events_of(const carmen::Log& log) {
  std::vector<Event> events;
  for (const carmen::Scan& scan : log.scans)
    events.push_back({scan.time, scan.line, &scan, nullptr});
  const auto scan_at = [&](Time time) {
    const auto found =
        std::lower_bound(log.scans.begin(), log.scans.end(), time,
                         [](const carmen::Scan& scan, Time moment) { return scan.time < moment; });
    return found != log.scans.end() && found->time == time && found->has_pose;
  };
  for (const carmen::Odometry& odometry : log.odometry) {
    if (log.corrected || scan_at(odometry.time)) continue;
    events.push_back({odometry.time, odometry.line, nullptr, &odometry});
  }
  std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
    return std::make_pair(a.time, a.line) < std::make_pair(b.time, b.line);
  });
  return events;
}

Status write_all(const carmen::Log& log, double laser_height, mcap::Writer& writer,
                 Conversion& conversion) {
  TopicWriter<sensor_msgs::msg::LaserScan> scans;
  TopicWriter<nav_msgs::msg::Odometry> poses;
  if (const Status done = scans.open(writer, "scan"); !done.ok()) return done;
  if (const Status done = poses.open(writer, "odometry"); !done.ok()) return done;
  if (const Status done = writer.write(mcap::Metadata{
          "carmen",
          {{"poses", log.corrected ? "corrected" : "odometry"}, {"clock", "ipc_time of the log"}}});
      !done.ok()) {
    return done;
  }
  const std::string frame = log.corrected ? "map" : "odom";
  for (const Event& event : events_of(log)) {
    Status done;
    if (event.odometry != nullptr) {
      const Pose laser = compose(event.odometry->pose, log.laser_on_robot);
      auto message = to_message(event.time, laser, laser_height, frame);
      message.twist().twist().linear().x(event.odometry->forward_speed);
      message.twist().twist().angular().z(event.odometry->yaw_rate);
      done = poses.write(writer, event.time, message);
    } else {
      if (event.scan->has_pose) {
        done = poses.write(writer, event.time,
                           to_message(event.time, event.scan->laser_pose, laser_height, frame));
      }
      if (done.ok()) done = scans.write(writer, event.time, to_message(*event.scan));
    }
    if (!done.ok()) return done;
  }
  conversion.scans = scans.count();
  conversion.poses = poses.count();
  return writer.close();
}

}  // namespace

Result<Conversion> convert_carmen(const carmen::Log& log, const std::filesystem::path& output,
                                  double laser_height) {
  std::filesystem::path partial = output;
  partial += ".partial";
  mcap::WriterParams params;
  params.profile = "ros2";
  params.overwrite = true;
  params.chunk_duration = Duration::zero();  // nothing is lost with a conversion that is cut
  auto writer = mcap::Writer::open(partial, params);
  if (!writer.ok()) return writer.error();

  Conversion conversion;
  conversion.corrected = log.corrected;
  for (const auto& [keyword, count] : log.skipped) conversion.skipped_lines += count;
  Status done = write_all(log, laser_height, *writer, conversion);
  std::error_code error;
  if (done.ok()) {
    std::filesystem::rename(partial, output, error);
    if (error) done = Error{output.string() + ": cannot be put in place: " + error.message()};
  }
  if (done.ok()) return conversion;
  std::filesystem::remove(partial, error);
  return done.error();
}

}  // namespace swiftlet
