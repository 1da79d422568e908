// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// What the vehicle is and does: the header, and how it flies.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimation/geometry/so3.hpp"
#include "gcs/screen/drawing/horizon.hpp"
#include "gcs/screen/drawing/widgets.hpp"
#include "gcs/screen/panels.hpp"

namespace swiftlet::screen {
namespace {

/// Columns of a name, before its value.
constexpr int kLabel = 9;

double degrees(double radians) {
  return radians * 180.0 / M_PI;
}

/// A name and a value; one that is stale is dim, with its age where there is room.
template <class T>
void row(const Pane& pane, int y, const char* label, const std::string& value,
         const Heard<T>& source, Time now) {
  pane.text(0, y, label, kDim);
  if (!source.known()) {
    pane.text(kLabel, y, "?", kDim);
    return;
  }
  const bool fresh = source.fresh(now);
  const int end = pane.text(kLabel, y, value, fresh ? kPlain : kDim);
  if (fresh) return;
  const std::string age = age_text(source.age(now));
  if (end + 1 + columns_of(age) <= pane.width()) {
    pane.text_before(pane.width(), y, age, kWarning);
  } else {
    pane.put(kLabel - 1, y, U'!', kWarning);
  }
}

/// Of a finite heading [rad].
const char* direction(double yaw) {
  constexpr const char* kNames[] = {"E", "NE", "N", "NW", "W", "SW", "S", "SE"};
  const double eighths = std::round(yaw / (0.25 * M_PI));
  return kNames[(static_cast<int>(std::fmod(eighths, 8.0)) + 8) % 8];
}

/// Of a goto and its like.
std::string way_text(const VehicleReport& report) {
  if (report.waypoint_count == 0) return "none";
  if (report.mission_done)
    return fmt::format("{} of {}, done", report.waypoint_count, report.waypoint_count);
  return fmt::format("to {} of {}", report.waypoint, report.waypoint_count);
}

std::string mission_text(const MissionReport& report) {
  using State = MissionReport::State;
  const char* state = to_string(report.state);
  const bool has_item = report.state == State::kFlying || report.state == State::kPaused;
  if (has_item) return fmt::format("{} of {} {}", report.item, report.count, state);
  return report.count == 0 ? state : fmt::format("{}, {} items", state, report.count);
}

/// What is flown: the vehicle's mission, a goto, or which mission waits.
void paint_mission(const Pane& pane, int y, const GroundStationModel& model, Time now) {
  const auto& vehicle = model.vehicle();
  const auto& mission = model.mission();
  const bool goes_elsewhere = vehicle.known() && vehicle->navigates && !model.mission_flies();
  if (mission.known() && !goes_elsewhere)
    return row(pane, y, "mission", mission_text(*mission), mission, now);
  row(pane, y, "mission", vehicle.known() ? way_text(*vehicle) : "?", vehicle, now);
}

void paint_attitude(const Pane& pane, const GroundStationModel& model, Time now) {
  const auto& pose = model.pose();
  if (!pose.known()) {
    pane.text(1, pane.height() / 2, "attitude not known", kDim);
    return;
  }
  const bool fresh = pose.fresh(now);
  draw_horizon(pane, pose->q_WB, fresh ? Style{Hue::kCyan} : kDim);
  if (!fresh) {
    pane.text(1, pane.height() - 1, " stale: " + age_text(pose.age(now)) + " ", kWarning);
  }
}

/// Its name is shorter, since a place on Earth needs the room.
void paint_fix(const Pane& pane, int y, const GroundStationModel& model, Time now) {
  const auto& fix = model.fix();
  const bool has_fix = fix.known() && fix->has_value();
  pane.text(0, y, "GPS", kDim);
  const std::string place =
      has_fix ? fmt::format("{:.5f} {:.5f}", (*fix)->position.latitude, (*fix)->position.longitude)
              : std::string(fix.known() ? "no fix" : "none");
  pane.text(has_fix ? 4 : kLabel, y, place, fix.fresh(now) ? kPlain : kDim);
  if (fix.known() && !fix.fresh(now)) pane.put(3, y, U'!', kWarning);
}

Style battery_style(double share) {
  if (share <= 0.2) return kAlarm;
  return share <= 0.3 ? kWarning : kGood;
}

/// "15.2 V 12.0 A ", as far as it is measured.
std::string measured_text(const BatteryReport& battery) {
  std::string text;
  if (std::isfinite(battery.voltage)) text += fmt::format("{:.1f} V ", battery.voltage);
  if (std::isfinite(battery.current)) text += fmt::format("{:.1f} A ", battery.current);
  return text;
}

void paint_battery(const Pane& pane, const GroundStationModel& model, Time now) {
  const int end = pane.width() - 1;
  const auto& battery = model.battery();
  if (!battery.known()) {
    pane.text_before(end, 0, "battery ?", kDim);
    return;
  }
  const bool fresh = battery.fresh(now);
  const std::string left =
      fresh ? time_left_text(model.battery_seconds_left(now)) : age_text(battery.age(now)) + " ago";
  std::string text = fmt::format("{:.0f} % {}", battery->percentage * 100.0, left);
  if (pane.width() >= 100) text = measured_text(*battery) + " " + text + " left";
  const Style style = fresh ? battery_style(battery->percentage) : kDim;
  pane.text_before(end, 0, text, style);
  const int bar = pane.width() >= 80 ? 8 : 0;
  const int before = end - columns_of(text) - 1;
  draw_bar(pane, before - bar, 0, bar, battery->percentage, style);
  if (pane.width() >= 80) pane.text_before(before - bar - 1, 0, "battery", kDim);
}

}  // namespace

int flight_rows(const GroundStationModel& model) {
  return model.claw().known() ? 7 : 6;
}

std::string age_text(Duration age) {
  const double seconds = to_seconds(age);
  if (seconds < 9.95) return fmt::format("{:.1f} s", std::max(seconds, 0.0));
  if (seconds < 99.5) return fmt::format("{:.0f} s", seconds);
  return fmt::format("{:.0f} min", seconds / 60.0);
}

std::string time_left_text(std::optional<double> seconds) {
  if (!seconds) return "?";
  if (*seconds < 99.5) return fmt::format("{:.0f} s", *seconds);
  if (*seconds > 99.0 * 60.0) return "> 99 min";
  return fmt::format("{:.0f} min", *seconds / 60.0);
}

void paint_header(const Pane& pane, const GroundStationModel& model, Time now) {
  const auto& vehicle = model.vehicle();
  paint_battery(pane, model, now);
  if (!vehicle.known()) {
    pane.text(1, 0, "no vehicle heard yet", kWarning);
    return;
  }
  const bool fresh = vehicle.fresh(now);
  int x = pane.text(1, 0, vehicle->mode, fresh ? kBold : kDim);
  const Style armed = vehicle->armed ? Style{Hue::kRed, true, false, false} : kGood;
  x = pane.text(x + 2, 0, vehicle->armed ? "ARMED" : "disarmed", fresh ? armed : kDim);
  if (fresh) {
    x = pane.text(x + 2, 0, "link ", kDim);
    x = pane.text(x, 0, age_text(vehicle.age(now)), kGood);
    if (pane.width() >= 100) {
      x = pane.text(x + 1, 0, fmt::format("{} reports/s", model.reports_per_s(now)), kDim);
      if (model.lives_on_telemetry(now)) pane.text(x + 1, 0, "by telemetry", kDim);
    }
  } else {
    constexpr Style lost{Hue::kRed, true, false, true};
    pane.text(x + 2, 0, " LINK LOST " + age_text(vehicle.age(now)) + " ", lost);
  }
}

void paint_flight(const Pane& pane, const GroundStationModel& model, Time now) {
  const int horizon = std::clamp(pane.height() - flight_rows(model), 3, 13);
  paint_attitude(pane.part({0, 0, pane.width(), horizon}), model, now);
  const auto& pose = model.pose();
  const auto& vehicle = model.vehicle();
  int y = horizon;
  const auto when = [](bool known, auto text) { return known ? text() : std::string("?"); };
  row(pane, y++, "height",
      when(vehicle.known() && pose.known(),
           [&] { return fmt::format("{:.2f} m {:+.1f}", vehicle->height, pose->v_WB_W.z()); }),
      vehicle, now);
  row(pane, y++, "speed",
      when(pose.known(), [&] { return fmt::format("{:.2f} m/s", pose->v_WB_W.head<2>().norm()); }),
      pose, now);
  row(pane, y++, "position",
      when(pose.known(),
           [&] { return fmt::format("{:.2f} {:.2f}", pose->p_WB.x(), pose->p_WB.y()); }),
      pose, now);
  row(pane, y++, "heading",
      when(pose.known(),
           [&] {
             const double yaw = yaw_of(pose->q_WB);
             return std::isfinite(yaw)
                        ? fmt::format("{}° {}", std::lround(degrees(yaw)), direction(yaw))
                        : std::string("?");
           }),
      pose, now);
  paint_fix(pane, y++, model, now);
  paint_mission(pane, y++, model, now);
  if (model.claw().known()) row(pane, y, "claw", model.claw()->state, model.claw(), now);
}

}  // namespace swiftlet::screen
