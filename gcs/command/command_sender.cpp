// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/command/command_sender.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "components/conversions.hpp"

namespace swiftlet {
namespace {

constexpr Duration kResend = std::chrono::milliseconds(200);

}  // namespace

void CommandSender::begin(const GroundCommand& command, Time now, Time first_send,
                          Duration patience) {
  command_ = command;
  id_ = fmt::format("gcs-{}-{}-{}", getpid(), now.time_since_epoch().count(), ++count_);
  deadline_ = first_send + patience;
  next_send_ = first_send;
  outcome_.reset();
}

void CommandSender::hear(const swiftlet_msgs::msg::CommandAck& ack) {
  if (!command_ || ack.id() != id_ || outcome_) return;
  outcome_ = {ack.accepted(), ack.accepted() ? command_->name + ": accepted" : ack.reason()};
}

void CommandSender::hear(const nav_msgs::msg::Odometry& odometry) {
  height_ = odometry.pose().pose().position().z();
}

std::optional<CommandOutcome> CommandSender::advance(Time now) {
  if (!command_) return std::nullopt;
  if (!outcome_ && now > deadline_) outcome_ = {false, why_no_answer()};
  if (outcome_) {
    command_.reset();
    return std::exchange(outcome_, std::nullopt);
  }
  if (now >= next_send_) send(now);
  return std::nullopt;
}

std::string CommandSender::why_no_answer() const {
  const int readers =
      command_->is_mission() ? topics_.waypoints.matched_readers() : topics_.mode.matched_readers();
  if (readers == 0) {
    return fmt::format(
        "{}: no vehicle answers in domain {}; is a commander running there, and is "
        "--vehicle right?",
        command_->name, topics_.domain);
  }
  if (command_->go_to && !command_->go_to->z && !height_) {
    return "goto: the vehicle's height is not known, no odometry is heard; give Z";
  }
  return fmt::format(
      "{}: not acknowledged; the command may have been carried out, see swiftlet gcs status",
      command_->name);
}

void CommandSender::send(Time now) {
  if (command_->is_mission()) {
    if (topics_.waypoints.matched_readers() == 0) return;
    if (command_->go_to_global) {
      send(make_mission(now, id_, {*command_->go_to_global}));
    } else {
      auto& place = *command_->go_to;
      if (!place.z && !height_) return;
      // The height at the first sending, so that each repetition is the same mission.
      if (!place.z) place.z = height_;
      send(make_mission(now, id_, {MissionWaypoint{{place.x, place.y, *place.z}, std::nullopt}}));
    }
  } else {
    if (topics_.mode.matched_readers() == 0) return;
    swiftlet_msgs::msg::ModeCommand message;
    message.header(make_header(now, frame::kMap));
    message.id(id_);
    message.command(command_->command);
    message.altitude(command_->altitude);
    message.item(command_->item);
    message.station(topics_.station);
    message.successor(command_->successor);
    topics_.mode.publish(message);
  }
  next_send_ = now + kResend;
}

void CommandSender::send(swiftlet_msgs::msg::Mission mission) {
  mission.station(topics_.station);
  topics_.waypoints.publish(mission);
}

}  // namespace swiftlet
