// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/commander/authority_desk.hpp"

#include "components/commander/request_message.hpp"
#include "components/conversions.hpp"
#include "components/manual_control_message.hpp"

namespace swiftlet {
namespace {

std::string name_of(const std::string& station) {
  return station.empty() ? "unnamed" : station;
}

using namespace std::chrono_literals;

/// Sticks come twenty times a second; who is silent for so long does not steer any more.
constexpr Duration kSilentSticks = 150ms;

}  // namespace

Duration AuthorityDesk::read_lease(const Config& config) {
  double lease = 30.0;
  config.read("control_lease", lease, {1.0, 86400.0});
  return from_seconds(lease);
}

Status AuthorityDesk::admit(const std::string& station, Time now) {
  return authority_.claim(name_of(station), now);
}

bool AuthorityDesk::admit_sticks(const swiftlet_msgs::msg::ManualControl& sticks, Time now) {
  const std::string& name = sticks.station();
  const bool is_remote = name.empty(), moved = from_msg(sticks).deflection() > dead_band_;
  if (!is_remote) {
    // Who touches nothing takes nothing.
    const bool asks = holder(now) == name || moved;
    if (asks ? !authority_.claim(name, now).ok() : !holder(now).empty()) return false;
  }
  const bool another =
      steering_ && steering_->name != name && now - steering_->heard <= kSilentSticks;
  if (another && !(moved && (is_remote || !steering_->moved))) return false;
  steering_ = {name, moved, now};
  return true;
}

std::optional<Result<Acceptance>> AuthorityDesk::carry_out(
    const swiftlet_msgs::msg::ModeCommand& command, Time now) {
  using namespace swiftlet_msgs::msg::ModeCommand_Constants;
  const std::string station = name_of(command.station());
  Status status;
  switch (command.command()) {
    case CONTROL_TAKE:
      status = authority_.take(station, now);
      break;
    case CONTROL_GIVE:
      status = authority_.give(station, command.successor(), now);
      break;
    case CONTROL_RELEASE:
      status = authority_.release(station, now);
      break;
    default:
      return std::nullopt;
  }
  if (!status.ok()) return refused(asked(command), status.error());
  return Acceptance::kChanged;
}

std::string AuthorityDesk::giver(Time now) const {
  return holder(now).empty() ? "" : authority_.state().giver;
}

AuthorityDesk::Link AuthorityDesk::hear(const swiftlet_msgs::msg::ComponentStatus& heartbeat,
                                        Time now) {
  const std::string station = name_of(heartbeat.instance());
  authority_.hear(station, now);
  const bool counts = holder(now).empty() || holder(now) == station || giver(now) == station;
  if (!counts || !(heartbeat.period() > 0.0)) return Link::kOfOthers;
  linked_ = station;
  return heartbeat.active() ? Link::kHeard : Link::kLeft;
}

bool AuthorityDesk::link_is_of_others(Time now) const {
  return !holder(now).empty() && holder(now) != linked_ && giver(now) != linked_;
}

void AuthorityDesk::write(swiftlet_msgs::msg::CommanderState& state) const {
  state.station(authority_.state().holder);
  state.station_heard(to_msg(authority_.state().heard));
  state.station_giver(authority_.state().giver);
}

void AuthorityDesk::restore(const swiftlet_msgs::msg::CommanderState& state) {
  authority_.restore({state.station(), from_msg(state.station_heard()), state.station_giver()});
}

}  // namespace swiftlet
