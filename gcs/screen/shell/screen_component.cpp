// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/shell/screen_component.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/conversions.hpp"
#include "components/manual_control_message.hpp"
#include "gcs/screen/shell/ground_commands.hpp"
#include "gcs/screen/shell/reports.hpp"

namespace swiftlet::screen {
namespace {

using namespace std::chrono_literals;

/// Keys are read and sticks sent that often; every second time a picture is drawn.
constexpr Duration kTick = 50ms;
constexpr int kPictureEvery = 2;
/// Sticks are to be heard before the mode that they steer is asked for.
constexpr Duration kSticksFirst = 200ms;

/// What must not wait for another command's answer.
bool is_urgent(Action::Kind kind) {
  using Kind = Action::Kind;
  return kind == Kind::kHover || kind == Kind::kLand || kind == Kind::kReturn ||
         kind == Kind::kDisarm;
}

}  // namespace

ScreenComponent::ScreenComponent(const ComponentContext& context, CursesTerminal& terminal,
                                 ErrorLines& errors)
    : VehicleListener(context),
      terminal_(terminal),
      errors_(errors),
      sender_({advertise(topic::mode), advertise(topic::waypoints), context.domain}),
      asker_(advertise(topic::parameter_request)) {
  manual_control_ = advertise(topic::manual_control);
  listen();
  every(kTick, [this](Time now) { advance(now); });
}

void ScreenComponent::listen() {
  subscribe(topic::odometry, [this](const nav_msgs::msg::Odometry& odometry) {
    model_.hear(from_msg(odometry), now());
    sender_.hear(odometry);
  });
  subscribe(topic::gps_fix,
            [this](const sensor_msgs::msg::NavSatFix& fix) { model_.hear(fix_of(fix), now()); });
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
}

void ScreenComponent::advance(Time now) {
  bool pressed = false;
  for (const KeyCode key : terminal_.keys()) {
    pressed = true;
    for (const Action& action : controller_.press(key, circumstances(now))) carry_out(action, now);
  }
  steer(now);
  if (const auto outcome = sender_.advance(now)) {
    tell(outcome->accepted ? Severity::kSuccess : Severity::kDanger, outcome->text);
  }
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
  if (sticks || steered_) manual_control_.publish(to_msg(sticks.value_or(Sticks{}), now));
  steered_ = sticks.has_value();
}

void ScreenComponent::carry_out(const Action& action, Time now) {
  using Kind = Action::Kind;
  if (action.kind == Kind::kQuit) return stop(0);
  if (action.kind == Kind::kListParameters || action.kind == Kind::kSetParameter) {
    return ask(action, now);
  }
  send(action, now);
}

void ScreenComponent::send(const Action& action, Time now) {
  const GroundCommand command = ground_command(action);
  const bool steers = action.kind == Action::Kind::kManual || action.kind == Action::Kind::kAssist;
  if (sender_.busy() && !is_urgent(action.kind)) {
    return tell(Severity::kCaution,
                fmt::format("{}: wait, {} is under way", command.name, sender_.name()));
  }
  sender_.begin(command, now, steers ? now + kSticksFirst : now);
  model_.set_command({command.name + ": sending...", Severity::kCaution});
}

void ScreenComponent::ask(const Action& action, Time now) {
  namespace request = swiftlet_msgs::msg::ParameterRequest_Constants;
  ParameterAsker::Request message;
  message.component_name(action.component);
  message.command(action.kind == Action::Kind::kSetParameter ? request::SET : request::LIST);
  message.name(action.name);
  message.value(action.value);
  asker_.ask(message, now);
}

void ScreenComponent::hear(const swiftlet_msgs::msg::ParameterReply& reply) {
  if (!reply.accepted()) return tell(Severity::kDanger, reply.reason());
  ParameterList& list = controller_.parameters();
  if (list.component != reply.component_name()) return;
  const bool is_whole = list.entries.empty();
  for (const auto& parameter : reply.parameters()) {
    const ParameterEntry entry{parameter.name(), parameter.value(), parameter.limits(),
                               parameter.live()};
    if (is_whole) {
      list.entries.push_back(entry);
      continue;
    }
    for (ParameterEntry& known : list.entries) {
      if (known.name == entry.name) known = entry;
    }
    tell(Severity::kSuccess,
         fmt::format("{}.{} is now {}", list.component, entry.name, entry.value));
  }
}

void ScreenComponent::tell(Severity severity, const std::string& text) {
  model_.set_command({text, severity});
  model_.note(now(), severity, text);
}

Circumstances ScreenComponent::circumstances(Time now) const {
  Circumstances circumstances;
  circumstances.now = now;
  circumstances.in_flight = model_.vehicle().known() && model_.vehicle()->in_flight;
  if (model_.pose().known() && model_.pose()->p_WB.allFinite()) {
    circumstances.vehicle = model_.pose()->p_WB;
  }
  for (const auto& [name, heard] : model_.components()) circumstances.components.push_back(name);
  return circumstances;
}

}  // namespace swiftlet::screen
