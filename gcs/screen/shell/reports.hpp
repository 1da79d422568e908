// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "components/topics.hpp"
#include "gcs/screen/state/ground_station_model.hpp"
#include "gcs/screen/state/parameter_list.hpp"

/// Between messages and what the screen's model has.
namespace swiftlet::screen {

VehicleReport report_of(const swiftlet_msgs::msg::VehicleStatus& status);
ParameterEntry::Changes changes_of(std::uint8_t changes);
MissionReport report_of(const swiftlet_msgs::msg::MissionState& mission);
LimitsReport report_of(const swiftlet_msgs::msg::FlightLimits& limits);
ClawReport report_of(const swiftlet_msgs::msg::ClawState& claw);
TelemetryReport report_of(const swiftlet_msgs::msg::Telemetry& telemetry);
/// Nothing where it is not that of a ground link.
std::optional<LinkReport> link_of(const diagnostic_msgs::msg::DiagnosticArray& diagnostics);
std::shared_ptr<const GridMap> map_of(const nav_msgs::msg::OccupancyGrid& map);
std::vector<Eigen::Vector2d> places_of(const nav_msgs::msg::Path& path);

}  // namespace swiftlet::screen
