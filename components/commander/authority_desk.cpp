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

bool is_centred(const swiftlet_msgs::msg::ManualControl& sticks) {
  return from_msg(sticks).deflection() == 0.0;
}

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
  if (sticks.station().empty()) return true;
  // Who touches nothing takes nothing.
  const bool asks = holder(now) == sticks.station() || !is_centred(sticks);
  return asks ? authority_.claim(sticks.station(), now).ok() : holder(now).empty();
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

void AuthorityDesk::hear(const swiftlet_msgs::msg::ComponentStatus& heartbeat, Time now) {
  authority_.hear(name_of(heartbeat.instance()), now);
}

bool AuthorityDesk::is_of_holder(const swiftlet_msgs::msg::ComponentStatus& heartbeat,
                                 Time now) const {
  return holder(now).empty() || holder(now) == name_of(heartbeat.instance());
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
