// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// What is done when a person has asked for it.
#include <fmt/format.h>

#include "gcs/screen/shell/ground_commands.hpp"
#include "gcs/screen/shell/reports.hpp"
#include "gcs/screen/shell/screen_component.hpp"

namespace swiftlet::screen {
namespace {

using namespace std::chrono_literals;
using Kind = Action::Kind;

/// Sticks are to be heard before the mode that they steer is asked for.
constexpr Duration kSticksFirst = 200ms;

/// For the answer to a command, which is repeated meanwhile: a link may be bad.
constexpr Duration kPatience = 10s;

bool steers(Kind kind) {
  return kind == Kind::kManual || kind == Kind::kAssist;
}

/// What must not wait for another command's answer.
bool is_urgent(Kind kind) {
  return kind == Kind::kHover || kind == Kind::kPauseMission || kind == Kind::kLand ||
         kind == Kind::kReturn || kind == Kind::kDisarm;
}

}  // namespace

void ScreenComponent::carry_out(const Action& action, Time now) {
  switch (action.kind) {
    case Kind::kQuit:
      return stop(0);
    case Kind::kListParameters:
    case Kind::kSetParameter:
      return ask(action, now);
    case Kind::kNote:
      return model_.note(now, action.severity, action.text);
    case Kind::kTell:
      return tell(action.severity, action.text);
    case Kind::kFlyMission:
      return bring(action, now);
    case Kind::kFetchMission:
      return fetch(now);
    case Kind::kSave:
      return save(action);
    case Kind::kLoad:
      return load(action);
    default:
      return send(action, now);
  }
}

void ScreenComponent::send(const Action& action, Time now) {
  const std::string name = ground_command(action).name;
  // A mission that is on its way must not begin to fly behind what stops the vehicle, or somebody
  // who steers it.
  if (errand_.brings() && (is_urgent(action.kind) || steers(action.kind))) {
    errand_.give_up();
    tell(Severity::kCaution, "upload: given up for " + name);
  }
  const bool waits = errand_.brings() || (sender_.busy() && !is_urgent(action.kind));
  if (!waits) return begin(action, now);
  tell(Severity::kCaution, fmt::format("{}: wait, {} is under way", name,
                                       errand_.brings() ? "an upload" : sender_.name()));
}

void ScreenComponent::begin(const Action& action, Time now) {
  const GroundCommand command = ground_command(action);
  pauses_ = action.kind == Kind::kPauseMission;
  sender_.begin(command, now, steers(action.kind) ? now + kSticksFirst : now, kPatience);
  model_.set_command({command.name + ": sending...", Severity::kCaution});
}

void ScreenComponent::take(const CommandOutcome& outcome, Time now) {
  tell(outcome.accepted ? Severity::kSuccess : Severity::kDanger, outcome.text);
  // It may have ended meanwhile, and the vehicle may do something else that is to be stopped.
  if (pauses_ && !outcome.accepted) {
    begin(action(Kind::kHover), now);
  }
}

void ScreenComponent::ask(const Action& action, Time now) {
  namespace request = swiftlet_msgs::msg::ParameterRequest_Constants;
  ParameterAsker::Request message;
  message.component_name(action.component);
  message.command(action.kind == Kind::kSetParameter ? request::SET : request::LIST);
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
                               changes_of(parameter.changes())};
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

}  // namespace swiftlet::screen
