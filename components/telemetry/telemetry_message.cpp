// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/telemetry/telemetry_message.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "components/conversions.hpp"
#include "components/runtime/message.hpp"
#include "components/runtime/utf8.hpp"

namespace swiftlet {
namespace {

using Message = swiftlet_msgs::msg::Telemetry;
namespace flag = swiftlet_msgs::msg::Telemetry_Constants;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
/// A quaternion whose length is further from one is no attitude.
constexpr double kMostDenormal = 1e-2;

/// NaN where it is no number that a float can hold.
float number(double value) {
  const bool fits = std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max());
  return fits ? static_cast<float>(value) : kNan;
}

std::uint16_t clamped(std::uint32_t count) {
  return static_cast<std::uint16_t>(std::min<std::uint32_t>(count, 0xffff));
}

void forget(Message& message) {
  for (auto* triple : {&message.position(), &message.velocity(), &message.attitude()}) {
    triple->fill(kNan);
  }
  message.mode(kUnknownMode);
  message.battery(kNan);
  message.voltage(kNan);
  message.time_left(kNan);
  message.height(kNan);
  message.latitude(std::numeric_limits<double>::quiet_NaN());
  message.longitude(std::numeric_limits<double>::quiet_NaN());
  message.altitude(kNan);
}

void raise(Message& message, std::uint8_t flag) {
  message.flags(static_cast<std::uint8_t>(message.flags() | flag));
}

void add(Message& message, const swiftlet_msgs::msg::VehicleStatus& status) {
  message.mode(status.mode());
  if (status.armed()) raise(message, flag::ARMED);
  if (status.ready()) raise(message, flag::READY);
  message.height(number(status.height()));
}

void set(std::array<float, 3>& triple, const Eigen::Vector3d& v) {
  for (std::size_t i = 0; i < 3; ++i) triple[i] = number(v[static_cast<Eigen::Index>(i)]);
}

void add(Message& message, const nav_msgs::msg::Odometry& odometry) {
  const RigidBodyState state = from_msg(odometry);
  const bool sound = state.p_WB.allFinite() && state.v_WB_W.allFinite() &&
                     std::abs(state.q_WB.norm() - 1.0) < kMostDenormal;
  if (!sound) return;
  const Eigen::Matrix3d R_WB = state.q_WB.normalized().toRotationMatrix();
  set(message.position(), state.p_WB);
  set(message.velocity(), state.v_WB_W);
  set(message.attitude(),
      {std::atan2(R_WB(2, 1), R_WB(2, 2)), std::asin(std::clamp(-R_WB(2, 0), -1.0, 1.0)),
       std::atan2(R_WB(1, 0), R_WB(0, 0))});
  raise(message, flag::POSITION_KNOWN);
}

void add(Message& message, const sensor_msgs::msg::BatteryState& battery) {
  message.voltage(number(static_cast<double>(battery.voltage())));
  if (!std::isfinite(battery.percentage())) return;  // as by its definition: not measured
  message.battery(battery.percentage());
  raise(message, flag::BATTERY_KNOWN);
}

void add(Message& message, const sensor_msgs::msg::NavSatFix& fix) {
  const bool sound = std::abs(fix.latitude()) <= 90.0 && std::abs(fix.longitude()) <= 180.0;
  if (!sound || fix.status().status() < sensor_msgs::msg::NavSatStatus_Constants::STATUS_FIX) {
    return;
  }
  message.latitude(fix.latitude());
  message.longitude(fix.longitude());
  message.altitude(number(fix.altitude()));
  raise(message, flag::GLOBAL_POSITION_KNOWN);
}

void add(Message& message, const swiftlet_msgs::msg::MissionState& mission) {
  message.item(clamped(mission.item()));
  message.item_count(clamped(mission.count()));
  if (mission.state() == swiftlet_msgs::msg::MissionState_Constants::FLYING) {
    raise(message, flag::MISSION_FLYING);
  }
}

std::string reason_of(const VehicleKnowledge& known) {
  if (known.guard != nullptr && known.guard->acting()) return known.guard->reason();
  return known.status != nullptr ? known.status->reason() : "no vehicle/status is heard";
}

}  // namespace

void set_reason(Message& telemetry, const std::string& reason) {
  telemetry.reason().clear();
  const std::size_t others = message_type<Message>().serialized_size(&telemetry);
  telemetry.reason(reason.substr(0, utf8_cut(reason, kTelemetryBytes - others)));
}

Message make_telemetry(Time now, const VehicleKnowledge& known) {
  Message message;
  forget(message);
  message.stamp(to_msg(now));
  message.health(known.health);
  if (known.status != nullptr) add(message, *known.status);
  if (known.odometry != nullptr) add(message, *known.odometry);
  if (known.battery != nullptr) add(message, *known.battery);
  if (known.battery != nullptr && known.time_left) message.time_left(number(*known.time_left));
  if (known.fix != nullptr) add(message, *known.fix);
  if (known.mission != nullptr) add(message, *known.mission);
  if (known.guard != nullptr && known.guard->acting()) raise(message, flag::GUARD_ACTING);
  if (known.claw != nullptr) message.claw(known.claw->state());
  set_reason(message, reason_of(known));
  return message;
}

}  // namespace swiftlet
