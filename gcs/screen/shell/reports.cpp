// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/shell/reports.hpp"

#include <cstdlib>
#include <iterator>

#include "components/conversions.hpp"
#include "components/mode_message.hpp"
#include "gcs/mission_state_name.hpp"

namespace swiftlet::screen {
namespace {

/// As the component ground_link writes it: "ground_link" has the total, "ground_link: TOPIC" a
/// topic.
constexpr char kLink[] = "ground_link";

double value_of(const diagnostic_msgs::msg::DiagnosticStatus& status, const char* key) {
  for (const auto& entry : status.values()) {
    if (entry.key() == key) return std::strtod(entry.value().c_str(), nullptr);
  }
  return 0.0;
}

}  // namespace

VehicleReport report_of(const swiftlet_msgs::msg::VehicleStatus& status) {
  using namespace swiftlet_msgs::msg::VehicleStatus_Constants;
  VehicleReport report;
  report.mode = mode_name(status.mode());
  report.in_flight = status.mode() != GROUNDED;
  report.navigates = status.mode() == INDOOR_NAVIGATION || status.mode() == INDOOR_EXPLORATION ||
                     status.mode() == GPS_GUIDANCE;
  report.armed = status.armed();
  report.ready = status.ready();
  report.reason = status.reason();
  report.height = status.height();
  report.waypoint = static_cast<int>(status.waypoint());
  report.waypoint_count = static_cast<int>(status.waypoint_count());
  report.mission_done = status.mission_done();
  report.takeoff_point = from_msg(status.takeoff_point()).head<2>();
  return report;
}

MissionReport report_of(const swiftlet_msgs::msg::MissionState& mission) {
  using State = MissionReport::State;
  MissionReport report;
  for (const State known : {State::kReady, State::kFlying, State::kPaused, State::kDone}) {
    if (static_cast<std::uint8_t>(known) == mission.state()) report.state = known;
  }
  report.item = static_cast<int>(mission.item());
  report.count = static_cast<int>(mission.count());
  report.reason = mission.reason();
  report.id = mission.id();
  if (mission.upload_refused()) report.refusal = mission.upload_reason();
  report.upload = mission.upload_id();
  return report;
}

ClawReport report_of(const swiftlet_msgs::msg::ClawState& claw) {
  using namespace swiftlet_msgs::msg::ClawState_Constants;
  constexpr const char* kNames[] = {"not moved yet", "opening", "open", "closing",
                                    "closed",        "holding", "fault"};
  static_assert(FAULT + 1 == std::size(kNames));
  if (claw.state() > FAULT) return {"?", ""};
  return {kNames[claw.state()], claw.state() == FAULT ? claw.reason() : ""};
}

std::optional<LinkReport> link_of(const diagnostic_msgs::msg::DiagnosticArray& diagnostics) {
  if (diagnostics.status().empty() || diagnostics.status().front().name() != kLink) {
    return std::nullopt;
  }
  LinkReport report;
  const std::string prefix = std::string(kLink) + ": ";
  for (const auto& status : diagnostics.status()) {
    const double bytes_per_s = value_of(status, "bytes_per_s");
    if (status.name() == kLink) {
      report.bytes_per_s = bytes_per_s;
      report.budget_bytes_per_s = value_of(status, "budget_bytes_per_s");
    } else if (status.name().rfind(prefix, 0) == 0) {
      report.topics.push_back({status.name().substr(prefix.size()), bytes_per_s,
                               value_of(status, "over_budget_per_s") > 0.0});
    }
  }
  return report;
}

std::shared_ptr<const GridMap> map_of(const nav_msgs::msg::OccupancyGrid& message) {
  auto map = std::make_shared<GridMap>();
  map->width = static_cast<int>(message.info().width());
  map->height = static_cast<int>(message.info().height());
  map->resolution = static_cast<double>(message.info().resolution());
  map->origin = from_msg(message.info().origin().position()).head<2>();
  map->cells.assign(message.data().begin(), message.data().end());
  return map;
}

std::vector<Eigen::Vector2d> places_of(const nav_msgs::msg::Path& path) {
  std::vector<Eigen::Vector2d> places;
  for (const auto& pose : path.poses()) {
    places.emplace_back(from_msg(pose.pose().position()).head<2>());
  }
  return places;
}

}  // namespace swiftlet::screen
