// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/cli/flight_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "components/sim/plan_view.hpp"
#include "components/sim/world.hpp"
#include "perception/map_io.hpp"

namespace swiftlet {
namespace {

double landing_error(const FlightReport& report) {
  const Eigen::Vector2d pad(report.scenario.start.x, report.scenario.start.y);
  return (report.record.final_position.head<2>() - pad).norm();
}

std::string reason(const FlightReport& report) {
  if (report.record.contacts > 0) {
    return fmt::format("touched '{}'; {}", report.record.last_contact, report.outcome.reason);
  }
  return report.outcome.reason;
}

/// JSON has no infinity.
nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

nlohmann::json to_json(const FlightReport& report) {
  const FlightRecord& record = report.record;
  nlohmann::json json;
  json["scenario"] = report.scenario.name;
  json["seed"] = report.scenario.seed;
  json["success"] = success(report);
  json["reason"] = reason(report);
  json["contacts"] = record.contacts;
  json["min_clearance_m"] = number(record.min_clearance);
  json["closest_at_m"] = {record.closest_at.x(), record.closest_at.y(), record.closest_at.z()};
  json["landing_error_m"] =
      record.on_ground ? number(landing_error(report)) : nlohmann::json(nullptr);
  json["position_rmse_m"] = {record.position_rmse.x(), record.position_rmse.y(),
                             record.position_rmse.z()};
  json["pose_nees"] = number(record.pose_nees);
  json["flight_time_s"] = report.outcome.flight_time;
  json["length_flown_m"] = length_flown(record);
  json["speed_factor"] = number(report.speed_factor);
  json["bag_hash"] = report.bag_hash ? nlohmann::json(*report.bag_hash) : nlohmann::json(nullptr);
  return json;
}

PlanView plan_view(const FlightReport& report) {
  const Scenario& scenario = report.scenario;
  PlanView view;
  view.title = fmt::format("Swiftlet: {}", scenario.name);
  view.subtitle = fmt::format("seed {}, {:.0f} s: {}", scenario.seed, report.outcome.flight_time,
                              reason(report));
  const World world = World::load(scenario.world, scenario.ground_models);
  view.outlines = world.slice(scenario.mission.takeoff_altitude);
  for (const Outline& outline : world.slice(0.3)) {
    if (!outline.is_ground) view.low_outlines.push_back(outline);
  }
  for (const Scenario::Obstacle& obstacle : scenario.obstacles) {
    World box;
    Eigen::Isometry3d T_WS = Eigen::Isometry3d::Identity();
    T_WS.translate(obstacle.position)
        .rotate(Eigen::AngleAxisd(obstacle.yaw, Eigen::Vector3d::UnitZ()));
    box.add_box(obstacle.name, T_WS, obstacle.size);
    const auto outlines = box.slice(obstacle.position.z());
    view.obstacles.insert(view.obstacles.end(), outlines.begin(), outlines.end());
  }
  view.flown = report.record.flown;
  view.flown_speed = report.record.flown_speed;
  view.reference = report.record.reference;
  for (const Scenario::Waypoint& waypoint : scenario.mission.waypoints) {
    view.waypoints.emplace_back(waypoint.x, waypoint.y);
  }
  view.pad = {scenario.start.x, scenario.start.y};
  return view;
}

Status write_json(const nlohmann::json& json, const std::filesystem::path& file) {
  std::ofstream stream(file);
  stream << json.dump(2) << "\n";
  stream.close();
  if (!stream) return Error{fmt::format("{}: cannot be written", file.string())};
  return {};
}

}  // namespace

bool success(const FlightReport& report) {
  return report.outcome.success && report.record.contacts == 0;
}

std::string summary(const FlightReport& report) {
  const FlightRecord& record = report.record;
  std::string text = fmt::format("{} {}: {}\n", success(report) ? "DONE  " : "FAILED",
                                 report.scenario.name, reason(report));
  text += fmt::format("flight     {:.1f} s and {:.1f} m, {:.1f} times real time\n",
                      report.outcome.flight_time, length_flown(record), report.speed_factor);
  text +=
      fmt::format("contacts   {}, clearance at least {:.2f} m, at {:.1f} {:.1f}\n", record.contacts,
                  record.min_clearance, record.closest_at.x(), record.closest_at.y());
  text += fmt::format("tracking   {:.3f} {:.3f} {:.3f} m RMSE in x, y, z\n",
                      record.position_rmse.x(), record.position_rmse.y(), record.position_rmse.z());
  if (record.on_ground) {
    text += fmt::format("landing    {:.3f} m from the pad's centre\n", landing_error(report));
  }
  if (report.bag_hash) text += fmt::format("recording  hash {}\n", *report.bag_hash);
  return text;
}

Status write(const FlightReport& report, const std::filesystem::path& folder) {
  Status status = write_json(to_json(report), folder / "report.json");
  if (!status.ok()) return status;
  status = draw_plan_view(plan_view(report), folder / "flight.png");
  if (!status.ok() || !report.map) return status;
  status = save_map(*report.map, folder / "map.pgm");
  if (!status.ok()) return status;
  return save_map(*report.map, folder / "map.png");
}

}  // namespace swiftlet
