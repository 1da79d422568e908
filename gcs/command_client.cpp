// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/command_client.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "components/conversions.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kTick = 10ms;
constexpr Duration kResend = 200ms;
/// From the start of the program to its end it may take two seconds.
constexpr Duration kTimeout = 1500ms;

}  // namespace

CommandClient::CommandClient(const ComponentContext& context, const GroundCommand& command)
    : Component(context),
      command_(command),
      id_(fmt::format("gcs-{}-{}", getpid(), now().time_since_epoch().count())),
      begin_(now()),
      next_send_(begin_) {
  mode_ = advertise(topic::mode);
  waypoints_ = advertise(topic::waypoints);
  subscribe(topic::mode_ack, [this](const swiftlet_msgs::msg::CommandAck& ack) {
    if (ack.id() != id_) return;
    finish(ack.accepted(), ack.accepted() ? command_.name + ": accepted" : ack.reason());
  });
  subscribe(topic::odometry, [this](const nav_msgs::msg::Odometry& odometry) {
    height_ = odometry.pose().pose().position().z();
  });
  every(kTick, [this](Time now) { advance(now); });
}

void CommandClient::advance(Time now) {
  if (now - begin_ > kTimeout) {
    const int readers =
        command_.is_mission() ? waypoints_.matched_readers() : mode_.matched_readers();
    if (readers == 0) {
      finish(false, fmt::format(
                        "{}: no vehicle answers in domain {}; is a commander running there, and is "
                        "--vehicle right?",
                        command_.name, context().domain));
    } else if (command_.go_to && !command_.go_to->z && !height_) {
      finish(false, "goto: the vehicle's height is not known, no odometry is heard; give Z");
    } else {
      finish(false, fmt::format("{}: not acknowledged; the command may have been carried out, see "
                                "swiftlet gcs status",
                                command_.name));
    }
    return;
  }
  if (now >= next_send_) send(now);
}

void CommandClient::send(Time now) {
  if (command_.go_to_global) {
    if (waypoints_.matched_readers() == 0) return;
    waypoints_.publish(make_mission(now, id_, {*command_.go_to_global}));
  } else if (command_.go_to) {
    if (waypoints_.matched_readers() == 0) return;
    const auto& place = *command_.go_to;
    if (!place.z && !height_) return;
    // The height at the first sending, so that each repetition is the same mission.
    if (!place.z) command_.go_to->z = height_;
    waypoints_.publish(make_mission(
        now, id_, {MissionWaypoint{{place.x, place.y, *command_.go_to->z}, std::nullopt}}));
  } else {
    if (mode_.matched_readers() == 0) return;
    swiftlet_msgs::msg::ModeCommand message;
    message.header(make_header(now, frame::kMap));
    message.id(id_);
    message.command(command_.command);
    message.altitude(command_.altitude);
    mode_.publish(message);
  }
  next_send_ = now + kResend;
}

void CommandClient::finish(bool accepted, const std::string& text) {
  if (!outcome_.text.empty()) return;
  outcome_ = {accepted, text};
  stop(accepted ? 0 : 1);
}

}  // namespace swiftlet
