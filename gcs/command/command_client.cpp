// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/command/command_client.hpp"

namespace swiftlet {
namespace {

constexpr Duration kTick = std::chrono::milliseconds(10);

}  // namespace

CommandClient::CommandClient(const ComponentContext& context, const std::string& station,
                             const GroundCommand& command, Duration patience)
    : Component(context),
      sender_({advertise(topic::mode), advertise(topic::waypoints), context.domain, station}) {
  subscribe(topic::mode_ack,
            [this](const swiftlet_msgs::msg::CommandAck& ack) { sender_.hear(ack); });
  subscribe(topic::odometry,
            [this](const nav_msgs::msg::Odometry& odometry) { sender_.hear(odometry); });
  sender_.begin(command, now(), now(), patience);
  every(kTick, [this](Time now) {
    const auto outcome = sender_.advance(now);
    if (!outcome) return;
    outcome_ = *outcome;
    stop(outcome_.accepted ? 0 : 1);
  });
}

}  // namespace swiftlet
