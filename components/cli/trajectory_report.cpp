// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/cli/trajectory_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "components/plot/figure.hpp"
#include "control/flatness.hpp"

namespace swiftlet {
namespace {

constexpr double kSampleRate = 100.0;  // [Hz]

/// One limit beside what the trajectory takes.
struct Row {
  const char* quantity;
  const char* unit;
  double extreme, limit;
};

std::vector<Row> rows_of(const TrajectoryReport& report) {
  const TrajectoryExtrema e = extrema(report.trajectory);
  const TrajectoryLimits& limits = report.task.limits;
  return {{"max_speed", "m/s", e.max_speed, limits.max_speed},
          {"max_acceleration", "m/s^2", e.max_acceleration, limits.max_acceleration},
          {"max_thrust_per_mass", "m/s^2", e.max_thrust_per_mass, limits.max_thrust_per_mass},
          {"min_thrust_per_mass", "m/s^2", e.min_thrust_per_mass, limits.min_thrust_per_mass},
          {"max_body_rate", "rad/s", e.max_body_rate, limits.max_body_rate},
          {"max_yaw_rate", "rad/s", e.max_yaw_rate, limits.max_yaw_rate}};
}

bool is_limit(const Row& row) {
  return std::isfinite(row.limit) && row.limit > 0.0;
}

/// A moment with all that is drawn and listed.
struct Sample {
  double t = 0.0;
  FlatReference reference;
  double thrust_per_mass = 0.0;
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  // in the body
};

std::vector<Sample> samples_of(const Trajectory& trajectory, double rate) {
  std::vector<Sample> samples;
  const double duration = to_seconds(trajectory.duration());
  const auto add = [&](double t) {
    Sample sample;
    sample.t = t;
    sample.reference = trajectory.evaluate(trajectory.start() + from_seconds(t));
    sample.thrust_per_mass =
        (sample.reference.acceleration + kGravity * Eigen::Vector3d::UnitZ()).norm();
    sample.angular_velocity = flat_state(sample.reference).w_WB_B;
    samples.push_back(sample);
  };
  // Durations are whole nanoseconds.
  const int count = static_cast<int>(std::floor(duration * rate + 1e-6));
  for (int i = 0; i <= count; ++i) add(std::min(i / rate, duration));
  if (samples.back().t < duration - 1e-6) add(duration);
  return samples;
}

template <class Value>
std::vector<double> each(const std::vector<Sample>& samples, Value value) {
  std::vector<double> values;
  for (const Sample& sample : samples) values.push_back(value(sample));
  return values;
}

/// A limit stands in the title of its panel. It is a line, too, where it does not dwarf the curve,
/// which goes from `rest` to `extreme`.
void show_limit(plot::Panel& panel, double limit, double rest, double extreme, const char* side) {
  constexpr double kNear = 3.0;
  if (!std::isfinite(limit) || limit <= 0.0) return;
  panel.title += fmt::format(", {} {:.4g}", side, limit);
  if (std::abs(limit - rest) > kNear * std::abs(extreme - rest)) return;
  panel.levels.push_back({limit, panel.levels.empty() ? "limit" : ""});
}

plot::Panel way_from_above(const TrajectoryReport& report, const std::vector<Sample>& samples) {
  plot::Panel panel{"From above", "x [m]", "y [m]"};
  panel.equal_aspect = true;
  panel.add("", each(samples, [](const Sample& s) { return s.reference.position.x(); }),
            each(samples, [](const Sample& s) { return s.reference.position.y(); }));
  std::vector<double> x{report.task.start.position.x()}, y{report.task.start.position.y()};
  panel.notes.push_back({x[0], y[0], "start"});
  for (std::size_t i = 0; i < report.task.waypoints.size(); ++i) {
    const Eigen::Vector3d& p = report.task.waypoints[i].position;
    x.push_back(p.x());
    y.push_back(p.y());
    const bool at_start = (p - report.task.start.position).head<2>().norm() < 1e-9;
    if (at_start) {
      panel.notes[0].text += fmt::format(", {}", i + 1);
    } else {
      panel.notes.push_back({p.x(), p.y(), fmt::format("{}", i + 1)});
    }
  }
  panel.add("", x, y, {plot::kRed, plot::Dash::kNoLine, plot::Marker::kDot});
  return panel;
}

plot::Figure figure_of(const TrajectoryReport& report) {
  // Enough for a smooth line, however long the flight.
  const double duration = to_seconds(report.trajectory.duration());
  const auto samples = samples_of(report.trajectory, std::min(kSampleRate, 4000.0 / duration));
  const std::vector<double> t = each(samples, [](const Sample& s) { return s.t; });
  const TrajectoryLimits& limits = report.task.limits;
  const TrajectoryExtrema most = extrema(report.trajectory);
  std::vector<plot::Mark> waypoints;
  for (const TrajectorySegment& segment : report.trajectory.segments()) {
    const double at = segment.duration_s + (waypoints.empty() ? 0.0 : waypoints.back().at);
    waypoints.push_back({at});
  }
  // The last is the end of the axis; numbers of many waypoints would hide each other.
  waypoints.pop_back();
  for (std::size_t i = 0; i < waypoints.size() && waypoints.size() <= 12; ++i) {
    waypoints[i].label = fmt::format("{}", i + 1);
  }

  plot::Figure figure;
  figure.columns = 2;
  figure.title = fmt::format("{}: minimum snap, {:.2f} s, cost {:.4g} m²/s⁷",
                             report.task.name.empty() ? "Trajectory" : report.task.name, duration,
                             snap_cost(report.trajectory));
  figure.panels.push_back(way_from_above(report, samples));
  const auto over_time = [&](const char* title, const char* y_label) -> plot::Panel& {
    plot::Panel& panel = figure.panel(title, "time [s]", y_label);
    panel.marks = waypoints;
    panel.legend = plot::Legend::kBelow;
    return panel;
  };
  plot::Panel& position = over_time("Position", "[m]");
  for (int axis = 0; axis < 3; ++axis) {
    position.add(std::string(1, "xyz"[axis]), t,
                 each(samples, [&](const Sample& s) { return s.reference.position[axis]; }));
  }
  plot::Panel& speed = over_time("Speed", "[m/s]");
  speed.add("speed", t, each(samples, [](const Sample& s) { return s.reference.velocity.norm(); }));
  show_limit(speed, limits.max_speed, 0.0, most.max_speed, "at most");
  plot::Panel& acceleration = over_time("Acceleration", "[m/s²]");
  acceleration.add("acceleration", t,
                   each(samples, [](const Sample& s) { return s.reference.acceleration.norm(); }));
  show_limit(acceleration, limits.max_acceleration, 0.0, most.max_acceleration, "at most");
  plot::Panel& thrust = over_time("Thrust per mass", "[m/s²]");
  thrust.add("thrust per mass", t,
             each(samples, [](const Sample& s) { return s.thrust_per_mass; }));
  show_limit(thrust, limits.max_thrust_per_mass, kGravity, most.max_thrust_per_mass, "at most");
  show_limit(thrust, limits.min_thrust_per_mass, kGravity, most.min_thrust_per_mass, "at least");
  plot::Panel& rate = over_time("Body rate", "[rad/s]");
  rate.add("body rate", t,
           each(samples, [](const Sample& s) { return s.angular_velocity.norm(); }));
  const char* names[] = {"roll", "pitch", "yaw"};
  for (int axis = 0; axis < 3; ++axis) {
    rate.add(names[axis], t,
             each(samples, [&](const Sample& s) { return s.angular_velocity[axis]; }),
             {"", plot::Dash::kDashed, plot::Marker::kNone, 1.4});
  }
  show_limit(rate, limits.max_body_rate, 0.0, most.max_body_rate, "at most");
  return figure;
}

}  // namespace

std::string to_text(const TrajectoryReport& report) {
  const Trajectory& trajectory = report.trajectory;
  std::string text = fmt::format("duration   {:.3f} s, {} pieces\ncost       {:.6g} m^2/s^7\n\n",
                                 to_seconds(trajectory.duration()), trajectory.segments().size(),
                                 snap_cost(trajectory));
  text += fmt::format("{:<22} {:>10} {:>10}\n", "at every moment", "extreme", "limit");
  for (const Row& row : rows_of(report)) {
    text += fmt::format("{:<22} {:>10.4g} {:>10} {}\n", row.quantity, row.extreme,
                        is_limit(row) ? fmt::format("{:.4g}", row.limit) : "none", row.unit);
  }
  text += fmt::format("\n{:<8} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "waypoint",
                      "after [s]", "at [s]", "x [m]", "y [m]", "z [m]", "yaw [rad]");
  double at = 0.0;
  for (std::size_t i = 0; i < trajectory.segments().size(); ++i) {
    const Waypoint& waypoint = report.task.waypoints[i];
    const double duration = trajectory.segments()[i].duration_s;
    at += duration;
    text += fmt::format("{:<8} {:>10.3f} {:>10.3f} {:>10.3f} {:>10.3f} {:>10.3f} {:>10.3f}\n",
                        i + 1, duration, at, waypoint.position.x(), waypoint.position.y(),
                        waypoint.position.z(), waypoint.yaw);
  }
  return text;
}

std::string to_json(const TrajectoryReport& report) {
  nlohmann::json json;
  json["name"] = report.task.name;
  json["duration_s"] = to_seconds(report.trajectory.duration());
  json["cost_m2_s7"] = snap_cost(report.trajectory);
  json["pieces_s"] = nlohmann::json::array();
  for (const TrajectorySegment& segment : report.trajectory.segments()) {
    json["pieces_s"].push_back(segment.duration_s);
  }
  json["rows"] = nlohmann::json::array();
  for (const Row& row : rows_of(report)) {
    json["rows"].push_back({{"quantity", row.quantity},
                            {"unit", row.unit},
                            {"extreme", row.extreme},
                            {"limit", is_limit(row) ? nlohmann::json(row.limit) : nullptr}});
  }
  return json.dump(2);
}

Status write_csv(const TrajectoryReport& report, const std::filesystem::path& file) {
  std::ofstream stream(file);
  stream << "time_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,ax_m_s2,ay_m_s2,az_m_s2,jx_m_s3,jy_m_s3,"
            "jz_m_s3,sx_m_s4,sy_m_s4,sz_m_s4,yaw_rad,yaw_rate_rad_s,thrust_per_mass_m_s2,"
            "roll_rate_rad_s,pitch_rate_rad_s,body_yaw_rate_rad_s\n";
  for (const Sample& sample : samples_of(report.trajectory, kSampleRate)) {
    const FlatReference& r = sample.reference;
    stream << fmt::format("{:.9g}", sample.t);
    for (const Eigen::Vector3d& v : {r.position, r.velocity, r.acceleration, r.jerk, r.snap}) {
      stream << fmt::format(",{:.9g},{:.9g},{:.9g}", v.x(), v.y(), v.z());
    }
    stream << fmt::format(",{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", r.yaw, r.yaw_rate,
                          sample.thrust_per_mass, sample.angular_velocity.x(),
                          sample.angular_velocity.y(), sample.angular_velocity.z());
  }
  stream.close();
  if (!stream) return Error{fmt::format("{}: cannot be written", file.string())};
  return {};
}

Status write_plot(const TrajectoryReport& report, const std::filesystem::path& file) {
  return figure_of(report).save(file);
}

}  // namespace swiftlet
