// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/carmen/carmen_log.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "components/bag/carmen/gzip_stream.hpp"
#include "components/bag/carmen/line_fields.hpp"

namespace swiftlet::carmen {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kMaxBeams = 100'000;
constexpr std::size_t kMaxLineLength = 4 << 20;
// Logs print poses with three to six digits.
constexpr double kSamePosition = 0.005;  // [m]
constexpr double kSameHeading = 0.005;   // [rad]

double wrapped(double angle) {
  return std::remainder(angle, 2.0 * kPi);
}

/// Pose of b in the frame of a.
Pose relative(const Pose& a, const Pose& b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double c = std::cos(a.theta);
  const double s = std::sin(a.theta);
  return {c * dx + s * dy, c * dy - s * dx, wrapped(b.theta - a.theta)};
}

class Parser {
 public:
  Parser(const std::string& name, const Params& params) : name_(name), params_(params) {}

  Status take_line(const std::string& line) {
    ++log_.lines;
    LineFields fields(line);
    if (fields.at_end()) return {};
    const std::string keyword(fields.word("keyword"));
    if (keyword.front() == '#') {
      ++log_.skipped["#"];
    } else if (keyword == "FLASER") {
      take_flaser(fields);
    } else if (keyword == "ROBOTLASER1") {
      take_robot_laser(fields, true);
    } else if (keyword == "RAWLASER1") {
      take_robot_laser(fields, false);
    } else if (keyword == "ODOM") {
      take_odometry(fields);
    } else if (keyword == "PARAM") {
      take_parameter(fields);
    } else {
      ++log_.skipped[keyword];
    }
    if (fields.ok()) return {};
    return Error{name_ + ": line " + std::to_string(log_.lines) + ": " + keyword + ": " +
                 fields.problem() + "; correct or remove the line"};
  }

  Log finish() {
    judge_correction();
    const auto earlier = [](const auto& a, const auto& b) { return a.time < b.time; };
    std::stable_sort(log_.scans.begin(), log_.scans.end(), earlier);
    std::stable_sort(log_.odometry.begin(), log_.odometry.end(), earlier);
    return std::move(log_);
  }

 private:
  static Pose pose(LineFields& fields) {
    Pose pose;
    pose.x = fields.number("x");
    pose.y = fields.number("y");
    pose.theta = fields.number("theta");
    return pose;
  }

  /// ipc_time host logger_time, at the end of each line.
  Time end_of_line(LineFields& fields) {
    const Time ipc_time = fields.time("ipc_time");
    fields.word("host");
    fields.time("logger_time");
    if (ipc_time.time_since_epoch().count() != 0) last_time_ = ipc_time;
    return last_time_;
  }

  std::vector<float> ranges(LineFields& fields, double max_range) {
    std::vector<float> ranges(fields.count("number of ranges", kMaxBeams));
    for (float& range : ranges) {
      const double metres = fields.number("range");
      if (!fields.ok()) break;
      range = metres >= max_range ? std::numeric_limits<float>::infinity()
                                  : static_cast<float>(std::max(metres, 0.0));
    }
    return ranges;
  }

  void take_flaser(LineFields& fields) {
    Scan scan;
    scan.line = log_.lines;
    scan.max_range = max_range_;
    scan.ranges = ranges(fields, max_range_);
    scan.has_pose = true;
    scan.laser_pose = pose(fields);
    scan.robot_pose = pose(fields);
    scan.time = end_of_line(fields);
    // The line says nothing of angles: the field of view is 180 degrees by convention. An even
    // number of beams divides it (180 beams: from -90 to +89 degrees in steps of 1), an odd
    // number has one on either end (181 beams: from -90 to +90).
    const std::size_t beams = scan.ranges.size();
    const std::size_t steps = beams % 2 == 0 ? beams : beams - 1;
    scan.angle_min = -kPi / 2.0;
    scan.angle_increment = kPi / static_cast<double>(std::max<std::size_t>(steps, 1));
    if (fields.ok()) log_.scans.push_back(std::move(scan));
  }

  void take_robot_laser(LineFields& fields, bool has_pose) {
    Scan scan;
    scan.line = log_.lines;
    fields.number("laser type");
    scan.angle_min = fields.number("start angle");
    fields.number("field of view");
    scan.angle_increment = fields.number("angular resolution");
    scan.max_range = fields.number("maximum range");
    fields.number("accuracy");
    fields.number("remission mode");
    if (!(scan.max_range > 0.0) || scan.max_range > max_range_) scan.max_range = max_range_;
    scan.ranges = ranges(fields, scan.max_range);
    scan.intensities.resize(fields.count("number of remissions", kMaxBeams));
    for (float& intensity : scan.intensities) {
      intensity = static_cast<float>(std::clamp(fields.number("remission"), -1e30, 1e30));
      if (!fields.ok()) break;
    }
    scan.has_pose = has_pose;
    if (has_pose) {
      scan.laser_pose = pose(fields);
      scan.robot_pose = pose(fields);
      for (const char* what :
           {"tv", "rv", "forward safety distance", "side safety distance", "turn axis"}) {
        fields.number(what);
      }
    }
    scan.time = end_of_line(fields);
    if (fields.ok()) log_.scans.push_back(std::move(scan));
  }

  void take_odometry(LineFields& fields) {
    Odometry odometry;
    odometry.line = log_.lines;
    odometry.pose = pose(fields);
    odometry.forward_speed = fields.number("tv");
    odometry.yaw_rate = fields.number("rv");
    fields.number("acceleration");
    odometry.time = end_of_line(fields);
    if (fields.ok()) log_.odometry.push_back(odometry);
  }

  void take_parameter(LineFields& fields) {
    const std::string name(fields.word("name"));
    const std::string value(fields.at_end() ? std::string_view() : fields.word("value"));
    if (!fields.ok()) return;
    log_.parameters[name] = value;
    if (name == "robot_front_laser_max" || name == "laser_front_laser_max") {
      LineFields number(value);
      const double metres = number.number("value");
      if (number.ok() && metres > 0.0) max_range_ = std::min(params_.max_range, metres);
    }
  }

  void judge_correction() {
    bool first = true;
    log_.corrected = log_.skipped.count("NEFF") != 0;
    for (const Scan& scan : log_.scans) {
      if (!scan.has_pose) continue;
      const Pose mount = relative(scan.robot_pose, scan.laser_pose);
      if (first) log_.laser_on_robot = mount;
      first = false;
      const Pose& known = log_.laser_on_robot;
      log_.corrected = log_.corrected ||
                       std::hypot(mount.x - known.x, mount.y - known.y) > kSamePosition ||
                       std::abs(wrapped(mount.theta - known.theta)) > kSameHeading;
    }
  }

  std::string name_;
  Params params_;
  double max_range_ = params_.max_range;
  Time last_time_;
  Log log_;
};

}  // namespace

Result<Log> parse_log(std::istream& text, const std::string& name, const Params& params) {
  Parser parser(name, params);
  std::size_t number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    if (line.size() > kMaxLineLength) {
      return Error{name + ": line " + std::to_string(number) + ": has more than " +
                   std::to_string(kMaxLineLength) + " bytes; this is no CARMEN log"};
    }
    if (const Status done = parser.take_line(line); !done.ok()) return done.error();
  }
  if (text.bad()) {
    return Error{name + ": line " + std::to_string(number) +
                 ": cannot be read further; the file is damaged or cut, fetch it again"};
  }
  return parser.finish();
}

Result<Log> read_log(const std::filesystem::path& path, const Params& params) {
  GzipStream stream(path);
  if (!stream.error().empty()) return Error{path.string() + ": " + stream.error()};
  auto log = parse_log(stream, path.string(), params);
  if (log.ok() && log->scans.empty() && log->odometry.empty()) {
    return Error{path.string() + ": line " + std::to_string(log->lines) +
                 ": the file ends here and has no FLASER, ROBOTLASER1, RAWLASER1 or ODOM line; "
                 "give a CARMEN log"};
  }
  return log;
}

Pose compose(const Pose& a, const Pose& b) {
  const double c = std::cos(a.theta);
  const double s = std::sin(a.theta);
  return {a.x + c * b.x - s * b.y, a.y + s * b.x + c * b.y, wrapped(a.theta + b.theta)};
}

}  // namespace swiftlet::carmen
