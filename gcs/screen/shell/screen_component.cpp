// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/shell/screen_component.hpp"

#include "components/conversions.hpp"
#include "components/fix_message.hpp"
#include "components/manual_control_message.hpp"
#include "gcs/screen/shell/reports.hpp"

namespace swiftlet::screen {
namespace {

using namespace std::chrono_literals;

/// Keys are read and sticks sent that often; every second time a picture is drawn.
constexpr Duration kTick = 50ms;
constexpr int kPictureEvery = 2;

}  // namespace

ScreenComponent::ScreenComponent(const ComponentContext& context, const std::string& station,
                                 CursesTerminal& terminal, ErrorLines& errors)
    : VehicleListener(context),
      station_(station),
      terminal_(terminal),
      errors_(errors),
      sender_({advertise(topic::mode), advertise(topic::waypoints), context.domain, station}),
      asker_(advertise(topic::parameter_request)) {
  model_.set_station(station);
  manual_control_ = advertise(topic::manual_control);
  mission_parts_ = advertise(topic::mission_upload);
  mission_fetch_ = advertise(topic::mission_fetch);
  listen();
  every(kTick, [this](Time now) { advance(now); });
}

void ScreenComponent::listen() {
  subscribe(topic::odometry, [this](const nav_msgs::msg::Odometry& odometry) {
    model_.hear(from_msg(odometry), now());
    sender_.hear(odometry);
  });
  subscribe(topic::gps_fix,
            [this](const sensor_msgs::msg::NavSatFix& fix) { model_.hear(from_msg(fix), now()); });
  subscribe(
      topic::claw_state,
      [this](const swiftlet_msgs::msg::ClawState& claw) { model_.hear(report_of(claw), now()); },
      Need::kOptional);
  subscribe(
      topic::telemetry,
      [this](const swiftlet_msgs::msg::Telemetry& telemetry) {
        model_.hear(report_of(telemetry), now());
      },
      Need::kOptional);
  subscribe(topic::diagnostics, [this](const diagnostic_msgs::msg::DiagnosticArray& diagnostics) {
    if (const auto link = link_of(diagnostics)) model_.hear(*link, now());
  });
  subscribe(topic::map, [this](const nav_msgs::msg::OccupancyGrid& map) {
    model_.hear_map(map_of(map), now());
  });
  subscribe(topic::path,
            [this](const nav_msgs::msg::Path& path) { model_.hear_path(places_of(path), now()); });
  subscribe(topic::mode_ack,
            [this](const swiftlet_msgs::msg::CommandAck& ack) { sender_.hear(ack); });
  subscribe(topic::parameter_reply, [this](const swiftlet_msgs::msg::ParameterReply& reply) {
    if (asker_.hear(reply)) hear(reply);
  });
  subscribe(
      topic::mission_download,
      [this](const swiftlet_msgs::msg::MissionPart& part) { errand_.hear(part, now()); },
      Need::kOptional);
}

void ScreenComponent::heard(const swiftlet_msgs::msg::MissionState& state) {
  errand_.hear(state, now());
}

void ScreenComponent::advance(Time now) {
  bool pressed = false;
  for (const KeyCode key : terminal_.keys()) {
    pressed = true;
    // Nobody steers by what is not seen.
    if (!is_large_enough(terminal_.width(), terminal_.height()) && key != key_code(' ')) continue;
    for (const Action& action : controller_.press(key, circumstances_of(model_, now))) {
      carry_out(action, now);
    }
  }
  steer(now);
  carry_mission(now);
  if (const auto outcome = sender_.advance(now)) take(*outcome, now);
  if (asker_.advance(now))
    tell(Severity::kDanger, "parameters: no answer; is the component there?");
  for (const LogLine& line : errors_.take()) model_.note(now, line.severity, line.text);
  model_.tick(now);
  if (++ticks_ % kPictureEvery != 0 && !pressed) return;
  Surface surface(terminal_.width(), terminal_.height());
  paint(surface, model_, controller_, picture_, now);
  terminal_.show(surface);
}

void ScreenComponent::steer(Time now) {
  const auto sticks = controller_.sticks(now);
  // At the end they are let go.
  if (sticks || steered_) {
    manual_control_.publish(to_msg(sticks.value_or(Sticks{}), now, station_));
  }
  steered_ = sticks.has_value();
}

void ScreenComponent::tell(Severity severity, const std::string& text) {
  model_.set_command({text, severity});
  model_.note(now(), severity, text);
}

}  // namespace swiftlet::screen
