// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/status_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "components/conversions.hpp"
#include "components/mission_state_name.hpp"
#include "components/mode_message.hpp"
#include "estimation/geometry/so3.hpp"
#include "gcs/screen/shell/reports.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

/// For the others, once the status is there.
constexpr Duration kMoment = 1s;
/// What is not heard for so long is not true any more.
constexpr Duration kStale = 1s;

std::string flight_text(const swiftlet_msgs::msg::VehicleStatus& status) {
  if (status.waypoint_count() == 0) return "none";
  if (status.mission_done()) return fmt::format("{} waypoints, done", status.waypoint_count());
  return fmt::format("waypoint {} of {}", status.waypoint(), status.waypoint_count());
}

double degrees(double radians) {
  return radians * 180.0 / 3.14159265358979323846;
}

std::string claw_text(const swiftlet_msgs::msg::ClawState& claw) {
  const screen::ClawReport report = screen::report_of(claw);
  return report.fault.empty() ? report.state : report.state + ": " + report.fault;
}

nlohmann::json json_of(const VehicleView& view) {
  nlohmann::json json = nlohmann::json::object();
  if (view.status) {
    const auto& status = *view.status;
    json["mode"] = mode_name(status.mode());
    json["armed"] = status.armed();
    json["ready"] = status.ready();
    json["reason"] = status.reason();
    json["height_m"] = status.height();
    json["mission"] = {{"id", status.mission_id()},
                       {"waypoint", status.waypoint()},
                       {"waypoint_count", status.waypoint_count()},
                       {"done", status.mission_done()}};
    json["control"] = status.station();
  }
  if (view.mission) {
    json["uploaded_mission"] = {{"id", view.mission->id()},
                                {"state", mission_state_name(view.mission->state())},
                                {"item", view.mission->item()},
                                {"count", view.mission->count()},
                                {"reason", view.mission->reason()}};
  }
  if (view.odometry) {
    const RigidBodyState state = from_msg(*view.odometry);
    json["position_m"] = {state.p_WB.x(), state.p_WB.y(), state.p_WB.z()};
    json["yaw_rad"] = yaw_of(state.q_WB);
    json["speed_m_s"] = state.v_WB_W.norm();
  }
  if (view.battery) {
    json["battery"] = {{"percentage", view.battery->percentage()},
                       {"voltage_v", view.battery->voltage()}};
  }
  if (view.claw) {
    json["claw"] = {{"state", claw_text(*view.claw)},
                    {"opening", view.claw->opening()},
                    {"current_a", view.claw->current()}};
  }
  return json;
}

bool is_complete(const VehicleView& view) {
  return view.status && view.mission && view.odometry && view.battery;
}

/// Components write what they want into their reasons.
constexpr auto kReplace = nlohmann::json::error_handler_t::replace;

}  // namespace

std::string describe(const VehicleView& view) {
  std::string text;
  if (view.status) {
    const auto& status = *view.status;
    text += fmt::format("mode      {}{}\n", mode_name(status.mode()),
                        status.armed() ? ", armed" : ", disarmed");
    text += fmt::format("ready     {}\n", status.ready() ? "yes" : "no");
    if (!status.reason().empty()) text += fmt::format("reason    {}\n", status.reason());
    text += fmt::format("height    {:.2f} m above take-off\n", status.height());
    text += fmt::format("flight    {}\n", flight_text(status));
    text +=
        fmt::format("control   {}\n", status.station().empty() ? "no station" : status.station());
  }
  if (view.mission) text += fmt::format("mission   {}\n", mission_state_text(*view.mission));
  if (view.odometry) {
    const RigidBodyState state = from_msg(*view.odometry);
    text += fmt::format("position  {:.2f} {:.2f} {:.2f} m, heading {:.0f} deg\n", state.p_WB.x(),
                        state.p_WB.y(), state.p_WB.z(), degrees(yaw_of(state.q_WB)));
    text += fmt::format("speed     {:.2f} m/s\n", state.v_WB_W.norm());
  } else {
    text += "position  not known: no odometry\n";
  }
  if (view.battery) {
    text +=
        fmt::format("battery   {:.0f} %, {:.1f} V, {:.1f} A\n", view.battery->percentage() * 100.0f,
                    view.battery->voltage(), -view.battery->current());
  }
  if (view.claw) {
    text += fmt::format("claw      {}, {:.0f} % open, {:.2f} A\n", claw_text(*view.claw),
                        100.0f * view.claw->opening(), view.claw->current());
  }
  return text;
}

std::string one_line(const VehicleView& view) {
  std::string text;
  if (view.status) {
    text += fmt::format("{:18}", mode_name(view.status->mode()));
    if (view.status->waypoint_count() > 0) text += flight_text(*view.status) + "  ";
  } else {
    text += "no vehicle/status  ";
  }
  if (view.odometry) {
    const RigidBodyState state = from_msg(*view.odometry);
    text += fmt::format("{:7.2f} {:7.2f} {:6.2f} m {:5.2f} m/s", state.p_WB.x(), state.p_WB.y(),
                        state.p_WB.z(), state.v_WB_W.norm());
  }
  if (view.battery) text += fmt::format("  {:3.0f} %", view.battery->percentage() * 100.0f);
  return text;
}

std::string to_json(const VehicleView& view) {
  return json_of(view).dump(2, ' ', false, kReplace);
}

std::string to_json_line(const VehicleView& view) {
  return json_of(view).dump(-1, ' ', false, kReplace);
}

StatusClient::StatusClient(const ComponentContext& context, Duration patience,
                           Terminal* until_ready)
    : StatusClient(context, patience, until_ready, nullptr) {}

StatusClient::StatusClient(const ComponentContext& context, Line each_second)
    : StatusClient(context, kPatience, nullptr, each_second) {}

StatusClient::StatusClient(const ComponentContext& context, Duration patience,
                           Terminal* until_ready, Line each_second)
    : Component(context),
      until_ready_(until_ready),
      each_second_(each_second),
      deadline_(now() + patience),
      status_heard_(now()) {
  subscribe(topic::vehicle_status, [this](const swiftlet_msgs::msg::VehicleStatus& status) {
    status_heard_ = now();
    view_.status = status;
  });
  subscribe(topic::odometry,
            [this](const nav_msgs::msg::Odometry& odometry) { view_.odometry = odometry; });
  subscribe(topic::battery,
            [this](const sensor_msgs::msg::BatteryState& battery) { view_.battery = battery; });
  subscribe(topic::mission_state,
            [this](const swiftlet_msgs::msg::MissionState& mission) { view_.mission = mission; });
  subscribe(
      topic::claw_state, [this](const swiftlet_msgs::msg::ClawState& claw) { view_.claw = claw; },
      Need::kOptional);
  every(each_second != nullptr ? Duration(1s) : Duration(20ms), [this](Time now) { advance(now); });
}

bool StatusClient::waits() const {
  if (!view_.status) return true;
  return until_ready_ != nullptr && !view_.status->ready() && !view_.status->armed();
}

void StatusClient::advance(Time now) {
  if (each_second_ != nullptr) {
    if (now - status_heard_ > kStale) view_ = {};
    fmt::print("{}\n", each_second_(view_));
    std::fflush(stdout);
    return;
  }
  if (!waits() && !std::exchange(has_what_it_waits_for_, true)) {
    deadline_ = std::min(deadline_, now + kMoment);
  }
  if (until_ready_ != nullptr) {
    until_ready_->show(view_.status ? "not ready: " + view_.status->reason() : "no vehicle heard");
  }
  const bool is_done = !waits() && is_complete(view_);
  if (is_done || now > deadline_) stop(view_.status ? 0 : 1);
}

}  // namespace swiftlet
