// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/command/command_watch.hpp"

#include <fmt/format.h>

#include "components/mission_state_name.hpp"
#include "components/mode_message.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
namespace command = swiftlet_msgs::msg::ModeCommand_Constants;
namespace mode = swiftlet_msgs::msg::VehicleStatus_Constants;

constexpr Duration kTick = 200ms;
/// A link that was away for so long is waited for no longer.
constexpr Duration kLost = 10s;

bool is_about_claw(std::uint8_t code) {
  return code == command::CLAW_OPEN || code == command::CLAW_CLOSE;
}

bool is_about_mission(std::uint8_t code) {
  return code == command::MISSION_START || code == command::MISSION_PAUSE ||
         code == command::MISSION_CLEAR;
}

}  // namespace

CommandOutcome CommandWatch::done(const std::string& how) const {
  return {true, fmt::format("{}: {}", command_.name, how)};
}

CommandOutcome CommandWatch::failed(const std::string& reason) const {
  return {false, fmt::format("{}: {}", command_.name, reason)};
}

std::optional<CommandOutcome> CommandWatch::hear(
    const swiftlet_msgs::msg::VehicleStatus& status) const {
  const bool hovers = status.mode() == mode::HOVER, is_down = status.mode() == mode::GROUNDED;
  const auto otherwise = [&](bool goes_on) -> std::optional<CommandOutcome> {
    if (goes_on) return std::nullopt;
    return failed(fmt::format("{}: {}", mode_name(status.mode()), status.reason()));
  };
  if (command_.is_mission() && status.mission_id() != id_) {
    return failed(fmt::format("the vehicle was sent elsewhere: {}: {}", mode_name(status.mode()),
                              status.reason()));
  }
  if (command_.is_mission() || command_.command == command::EXPLORE) {
    const std::uint8_t by = command_.command == command::EXPLORE && !command_.is_mission()
                                ? mode::INDOOR_EXPLORATION
                            : command_.go_to_global ? mode::GPS_GUIDANCE
                                                    : mode::INDOOR_NAVIGATION;
    if (hovers && status.mission_done()) return done("done");
    return otherwise(status.mode() == by);
  }
  switch (command_.command) {
    case command::ARM:
      return status.armed() ? done("armed") : std::optional<CommandOutcome>();
    case command::DISARM:
      return !status.armed() ? done("disarmed") : std::optional<CommandOutcome>();
    case command::TAKEOFF:
      if (hovers) return done(fmt::format("hovers at {:.2f} m", status.height()));
      return otherwise(status.mode() == mode::TAKEOFF);
    case command::LAND:
      if (is_down) return done("landed");
      return otherwise(status.mode() == mode::LAND);
    case command::RETURN:
      if (is_down) return done("back, and landed");
      return otherwise(status.mode() == mode::LAND || status.mode() == mode::INDOOR_NAVIGATION ||
                       status.mode() == mode::GPS_GUIDANCE);
    case command::HOVER:
      return hovers ? done("hovers") : otherwise(false);
    case command::MANUAL:
    case command::ASSIST:
      return done(mode_name(status.mode()));
    case command::CONTROL_TAKE:
    case command::CONTROL_GIVE:
    case command::CONTROL_RELEASE:
      return done(status.station().empty() ? "no station has control"
                                           : status.station() + " has control");
    default:
      return std::nullopt;  // about something else than the mode
  }
}

std::optional<CommandOutcome> CommandWatch::hear(
    const swiftlet_msgs::msg::MissionState& state) const {
  using namespace swiftlet_msgs::msg::MissionState_Constants;
  if (command_.command == command::MISSION_PAUSE) return done("paused");
  if (command_.command == command::MISSION_CLEAR) return done("cleared");
  if (state.state() == DONE) return done(fmt::format("all {} items done", state.count()));
  if (state.state() == FLYING) return std::nullopt;
  if (state.state() == PAUSED) {
    return failed(
        fmt::format("paused at item {} of {}: {}", state.item(), state.count(), state.reason()));
  }
  return failed("the vehicle has no mission any more");
}

std::optional<CommandOutcome> CommandWatch::hear(const swiftlet_msgs::msg::ClawState& state) const {
  using namespace swiftlet_msgs::msg::ClawState_Constants;
  const bool opens = command_.command == command::CLAW_OPEN;
  if (state.state() == FAULT) return failed(state.reason());
  if (opens && state.state() == OPEN) return done("open");
  if (!opens && state.state() == CLOSED) return done("closed, on nothing");
  if (!opens && state.state() == HOLDING) return done("holds something");
  return std::nullopt;
}

WaitClient::WaitClient(const ComponentContext& context, const GroundCommand& command,
                       const std::string& id, Terminal& terminal)
    : Component(context), watch_(command, id), terminal_(terminal), heard_(now()) {
  const bool about_mission = !command.is_mission() && is_about_mission(command.command);
  const bool about_claw = !command.is_mission() && is_about_claw(command.command);
  const bool about_mode = !about_mission && !about_claw;
  subscribe(topic::vehicle_status,
            [this, about_mode](const swiftlet_msgs::msg::VehicleStatus& status) {
              heard_ = now();
              status_ = status;
              if (about_mode) take(watch_.hear(status));
            });
  if (about_mission) {
    subscribe(topic::mission_state, [this](const swiftlet_msgs::msg::MissionState& state) {
      mission_ = state;
      take(watch_.hear(state));
    });
  }
  if (about_claw) {
    subscribe(topic::claw_state,
              [this](const swiftlet_msgs::msg::ClawState& state) { take(watch_.hear(state)); });
  }
  every(kTick, [this](Time now) { advance(now); });
}

void WaitClient::take(const std::optional<CommandOutcome>& outcome) {
  if (!outcome || !outcome_.text.empty()) return;
  outcome_ = *outcome;
  terminal_.clear();
  stop(outcome_.accepted ? 0 : 1);
}

void WaitClient::advance(Time now) {
  if (now - heard_ > kLost) {
    return take(CommandOutcome{
        false, fmt::format("nothing was heard of the vehicle for {:.0f} s; how it went is not "
                           "known, see swiftlet gcs status",
                           to_seconds(kLost))});
  }
  if (!status_) return;
  std::string line = fmt::format("{}, {:.2f} m", mode_name(status_->mode()), status_->height());
  if (mission_) {
    line += fmt::format(", item {} of {}, {}", mission_->item(), mission_->count(),
                        mission_state_name(mission_->state()));
  } else if (status_->waypoint_count() > 0) {
    line += fmt::format(", waypoint {} of {}", status_->waypoint(), status_->waypoint_count());
  }
  terminal_.show(line);
}

}  // namespace swiftlet
