// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/shell/reports.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>

#include "components/conversions.hpp"
#include "components/fix_message.hpp"
#include "components/mode_message.hpp"
#include "components/telemetry/telemetry_message.hpp"

namespace swiftlet::screen {
namespace {

/// As the component ground_link writes it: "ground_link" has the total, "ground_link: TOPIC" a
/// topic.
constexpr char kLink[] = "ground_link";
constexpr char kSerialLink[] = "serial_link";

namespace flag = swiftlet_msgs::msg::Telemetry_Constants;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

VehicleReport report_of_mode(std::uint8_t mode) {
  using namespace swiftlet_msgs::msg::VehicleStatus_Constants;
  VehicleReport report;
  report.mode = mode_name(mode);
  report.in_flight = mode != GROUNDED;
  report.navigates =
      mode == INDOOR_NAVIGATION || mode == INDOOR_EXPLORATION || mode == GPS_GUIDANCE;
  return report;
}

ClawReport report_of_claw(std::uint8_t state, const std::string& reason) {
  using namespace swiftlet_msgs::msg::ClawState_Constants;
  constexpr const char* kNames[] = {"not moved yet", "opening", "open", "closing",
                                    "closed",        "holding", "fault"};
  static_assert(FAULT + 1 == std::size(kNames));
  if (state > FAULT) return {"?", ""};
  return {kNames[state], state == FAULT ? reason : ""};
}

bool has(const swiftlet_msgs::msg::Telemetry& telemetry, std::uint8_t bit) {
  return (telemetry.flags() & bit) != 0;
}

Eigen::Vector3d vector_of(const std::array<float, 3>& triple) {
  return Eigen::Vector3f(triple.data()).cast<double>();
}

RigidBodyState pose_of(const swiftlet_msgs::msg::Telemetry& telemetry) {
  const Eigen::Vector3d attitude = vector_of(telemetry.attitude());
  RigidBodyState state;
  state.p_WB = vector_of(telemetry.position());
  state.v_WB_W = vector_of(telemetry.velocity());
  state.q_WB = Eigen::AngleAxisd(attitude.z(), Eigen::Vector3d::UnitZ()) *
               Eigen::AngleAxisd(attitude.y(), Eigen::Vector3d::UnitY()) *
               Eigen::AngleAxisd(attitude.x(), Eigen::Vector3d::UnitX());
  return state;
}

MissionReport mission_of(const swiftlet_msgs::msg::Telemetry& telemetry) {
  using State = MissionReport::State;
  MissionReport report;
  report.item = telemetry.item();
  report.count = telemetry.item_count();
  if (report.count > 0) report.state = report.item > 0 ? State::kPaused : State::kReady;
  if (has(telemetry, flag::MISSION_FLYING)) report.state = State::kFlying;
  return report;
}

TelemetryReport::Health health_of(std::uint8_t level) {
  using Health = TelemetryReport::Health;
  using namespace diagnostic_msgs::msg::DiagnosticStatus_Constants;
  if (level == OK) return Health::kWell;
  if (level == WARN) return Health::kWarned;
  return level == ERROR ? Health::kError : Health::kUnknown;
}

const std::string* find_value(const diagnostic_msgs::msg::DiagnosticStatus& status,
                              const char* key) {
  for (const auto& entry : status.values()) {
    if (entry.key() == key) return &entry.value();
  }
  return nullptr;
}

double value_of(const diagnostic_msgs::msg::DiagnosticStatus& status, const char* key) {
  const std::string* value = find_value(status, key);
  return value == nullptr ? 0.0 : std::strtod(value->c_str(), nullptr);
}

/// On the ground: what comes down is what the line carries.
LinkReport serial_link_of(const diagnostic_msgs::msg::DiagnosticStatus& status) {
  LinkReport report;
  report.bytes_per_s = value_of(status, "bytes_received_per_s");
  report.budget_bytes_per_s = value_of(status, "capacity_bytes_per_s");
  report.topics = {{"telemetry, answers (down)", report.bytes_per_s, false},
                   {"commands (up)", value_of(status, "bytes_sent_per_s"), false}};
  return report;
}

}  // namespace

VehicleReport report_of(const swiftlet_msgs::msg::VehicleStatus& status) {
  VehicleReport report = report_of_mode(status.mode());
  report.armed = status.armed();
  report.ready = status.ready();
  report.reason = status.reason();
  report.height = status.height();
  report.waypoint = static_cast<int>(status.waypoint());
  report.waypoint_count = static_cast<int>(status.waypoint_count());
  report.mission_done = status.mission_done();
  report.takeoff_point = from_msg(status.takeoff_point());
  report.station = status.station();
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

LimitsReport report_of(const swiftlet_msgs::msg::FlightLimits& limits) {
  return {{limits.fence_radius(), limits.fence_height()},
          limits.gps_altitude(),
          limits.gps_speed(),
          limits.climb_speed(),
          limits.descent_speed(),
          limits.clearance(),
          limits.low_battery(),
          limits.endurance(),
          limits.most_items()};
}

ParameterEntry::Changes changes_of(std::uint8_t changes) {
  using namespace swiftlet_msgs::msg::Parameter_Constants;
  if (changes == AT_ANY_TIME) return ParameterEntry::Changes::kAtAnyTime;
  return changes == ON_GROUND ? ParameterEntry::Changes::kOnGround
                              : ParameterEntry::Changes::kAtStart;
}

ClawReport report_of(const swiftlet_msgs::msg::ClawState& claw) {
  return report_of_claw(claw.state(), claw.reason());
}

TelemetryReport report_of(const swiftlet_msgs::msg::Telemetry& telemetry) {
  TelemetryReport report;
  if (telemetry.mode() != kUnknownMode) {
    report.vehicle = report_of_mode(telemetry.mode());
    report.vehicle->armed = has(telemetry, flag::ARMED);
    report.vehicle->ready = has(telemetry, flag::READY);
    report.vehicle->reason = telemetry.reason();
    report.vehicle->height = static_cast<double>(telemetry.height());
  }
  if (has(telemetry, flag::POSITION_KNOWN)) report.pose = pose_of(telemetry);
  if (has(telemetry, flag::BATTERY_KNOWN)) {
    report.battery = BatteryReport{static_cast<double>(telemetry.battery()),
                                   static_cast<double>(telemetry.voltage()), kNan, kNan};
  }
  if (std::isfinite(telemetry.time_left())) {
    report.battery_seconds_left = static_cast<double>(telemetry.time_left());
  }
  if (has(telemetry, flag::GLOBAL_POSITION_KNOWN)) {
    report.fix = GlobalFix{
        {telemetry.latitude(), telemetry.longitude(), static_cast<double>(telemetry.altitude())},
        kUnknownFixSigma};
  }
  report.mission = mission_of(telemetry);
  namespace claw = swiftlet_msgs::msg::ClawState_Constants;
  if (telemetry.claw() != claw::UNKNOWN) {
    report.claw = report_of_claw(telemetry.claw(), "has a fault");
  }
  report.guard = {has(telemetry, flag::GUARD_ACTING), telemetry.reason()};
  report.health = health_of(telemetry.health());
  return report;
}

std::optional<LinkReport> link_of(const diagnostic_msgs::msg::DiagnosticArray& diagnostics) {
  if (diagnostics.status().empty()) return std::nullopt;
  const auto& first = diagnostics.status().front();
  if (first.name() == kSerialLink) return serial_link_of(first);
  if (first.name() != kLink) return std::nullopt;
  LinkReport report;
  const std::string prefix = std::string(kLink) + ": ";
  for (const auto& status : diagnostics.status()) {
    const double bytes_per_s = value_of(status, "bytes_per_s");
    if (status.name() == kLink) {
      report.bytes_per_s = bytes_per_s;
      report.budget_bytes_per_s = value_of(status, "budget_bytes_per_s");
    } else if (status.name().rfind(prefix, 0) == 0 && find_value(status, "bytes_per_s")) {
      // What comes from the ground has no share.
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
  // The message's float, as the decimal number that was meant.
  map->resolution = std::round(static_cast<double>(message.info().resolution()) * 1e6) / 1e6;
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
