// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/sticks/stick_client.hpp"

#include <fmt/format.h>

#include "components/conversions.hpp"
#include "components/manual_control_message.hpp"
#include "components/mode_message.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kPeriod = 50ms;
constexpr Duration kHeartbeat = 250ms;
/// So long the end waits until the vehicle has heard that it is one.
constexpr Duration kFarewell = 1s;
/// From its start on it waits so long for somebody who hears it.
constexpr Duration kTimeout = 1500ms;

}  // namespace

StickClient::StickClient(const ComponentContext& context, const std::string& station,
                         const Held& held, bool by_keys, Terminal& terminal)
    : Component(context),
      station_(station),
      held_(held),
      by_keys_(by_keys),
      terminal_(terminal),
      keys_(held.sticks.assisted),
      begin_(now()) {
  manual_control_ = advertise(topic::manual_control);
  subscribe(topic::vehicle_status,
            [this](const swiftlet_msgs::msg::VehicleStatus& status) { status_ = status; });
  every(kPeriod, [this](Time now) { advance(now); });
}

StickClient::~StickClient() {
  send({}, now());
  terminal_.clear();
}

void StickClient::advance(Time now) {
  if (!matched_ && manual_control_.matched_readers() > 0) matched_ = now;
  if (!matched_) {
    if (now - begin_ < kTimeout) return;
    fmt::print(stderr,
               "stick: no vehicle answers in domain {}; is a commander running there, and is "
               "--vehicle right?\n",
               context().domain);
    return stop(1);
  }
  if (!by_keys_) {
    if (now - *matched_ >= from_seconds(held_.duration_s)) return end_held();
    return send(held_.sticks, now);
  }
  for (const Key pressed : terminal_.keys()) keys_.press(pressed, now);
  const Sticks sticks = keys_.at(now);
  send(sticks, now);
  show(sticks);
}

void StickClient::send(const Sticks& sticks, Time now) {
  manual_control_.publish(to_msg(sticks, now, station_));
}

bool StickClient::is_refused() const {
  return status_ && !status_->station().empty() && status_->station() != station_;
}

void StickClient::end_held() {
  using namespace swiftlet_msgs::msg::VehicleStatus_Constants;
  const bool on_ground = status_ && status_->mode() == GROUNDED;
  if (is_refused()) {
    fmt::print(stderr, "stick: not heard: station '{}' has control, not '{}'\n", status_->station(),
               station_);
  } else if (on_ground) {
    fmt::print(stderr, "stick: nothing was flown: the vehicle is on the ground; send takeoff\n");
  }
  stop(is_refused() || on_ground ? 1 : 0);
}

void StickClient::show(const Sticks& sticks) {
  if (is_refused()) {
    return terminal_.show(fmt::format("{:18} not heard: station '{}' has control",
                                      mode_name(status_->mode()), status_->station()));
  }
  terminal_.show(fmt::format(
      "{:18} forward {:+.0f}  left {:+.0f}  up {:+.0f}  turn {:+.0f}  takes over into {}",
      status_ ? mode_name(status_->mode()) : "no vehicle/status", sticks.forward, sticks.left,
      sticks.up, sticks.turn, sticks.assisted ? "Assisted Manual" : "Manual"));
}

Heartbeat::Heartbeat(const ComponentContext& context, const std::string& station, Absence absence)
    : Component(context), station_(station), absence_(absence) {
  heartbeat_ = advertise(topic::gcs_heartbeat);
  every(kHeartbeat, [this](Time) { send(true); });
}

Heartbeat::~Heartbeat() {
  if (absence_ == Absence::kIsNot) return;
  send(false);
  // Who ends at once takes back what is under way. Should the word get lost all the same, the
  // vehicle misses this ground station, which is the safe side.
  heartbeat_.wait_until_acknowledged(kFarewell);
}

void Heartbeat::send(bool stays) {
  swiftlet_msgs::msg::ComponentStatus message;
  message.header(make_header(now(), ""));
  message.component_name(name());
  message.process(context().process);
  message.instance(station_);
  message.active(stays);
  // Who promises nothing is not missed.
  message.period(absence_ == Absence::kIsMissed ? to_seconds(kHeartbeat) : 0.0);
  heartbeat_.publish(message);
}

}  // namespace swiftlet
