// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/battery_message.hpp"
#include "components/runtime/supervision/staleness.hpp"
#include "components/telemetry/health_summary.hpp"
#include "components/telemetry/telemetry_message.hpp"
#include "components/topics.hpp"
#include "estimation/battery/battery_clock.hpp"

namespace swiftlet {
namespace {

/// The last message of a topic, as long as it is not stale.
template <class T>
class Latest {
 public:
  explicit Latest(const Topic<T>& topic) : watch_(topic.period) {}
  void hear(const T& message, Time now) {
    message_ = message;
    watch_.heard(now);
  }
  const T* get(Time now) const { return watch_.stale(now) ? nullptr : &message_; }

 private:
  T message_;
  StalenessWatch watch_;
};

/// All that matters of the vehicle in one small message, five times a second.
class TelemetryComponent : public Component {
 public:
  explicit TelemetryComponent(const ComponentContext& context) : Component(context) {
    telemetry_ = advertise(topic::telemetry);
    listen(topic::vehicle_status, status_);
    listen(topic::odometry, odometry_);
    listen(topic::gps_fix, fix_);
    listen(topic::guard_status, guard_);
    listen(topic::mission_state, mission_);
    listen(topic::claw_state, claw_);
    subscribe(
        topic::battery,
        [this](const sensor_msgs::msg::BatteryState& battery) {
          battery_.hear(battery, now());
          battery_clock_.add(from_msg(battery), now());
        },
        Need::kOptional);
    subscribe(topic::diagnostics, [this](const diagnostic_msgs::msg::DiagnosticArray& report) {
      health_.hear(report, now());
    });
    every(topic::telemetry.period, [this](Time now) { tell(now); });
  }

 private:
  /// None of them is needed: what is missing is told as such.
  template <class T>
  void listen(const Topic<T>& topic, Latest<T>& latest) {
    subscribe(
        topic, [this, &latest](const T& message) { latest.hear(message, now()); }, Need::kOptional);
  }

  void tell(Time now) {
    VehicleKnowledge known;
    known.status = status_.get(now);
    known.odometry = odometry_.get(now);
    known.battery = battery_.get(now);
    known.fix = fix_.get(now);
    known.guard = guard_.get(now);
    known.mission = mission_.get(now);
    known.claw = claw_.get(now);
    known.time_left = battery_clock_.seconds_left(now);
    known.health = health_.worst(now);
    telemetry_.publish(make_telemetry(now, known));
  }

  Latest<swiftlet_msgs::msg::VehicleStatus> status_{topic::vehicle_status};
  Latest<nav_msgs::msg::Odometry> odometry_{topic::odometry};
  Latest<sensor_msgs::msg::BatteryState> battery_{topic::battery};
  Latest<sensor_msgs::msg::NavSatFix> fix_{topic::gps_fix};
  Latest<swiftlet_msgs::msg::GuardStatus> guard_{topic::guard_status};
  Latest<swiftlet_msgs::msg::MissionState> mission_{topic::mission_state};
  Latest<swiftlet_msgs::msg::ClawState> claw_{topic::claw_state};
  BatteryClock battery_clock_;
  HealthSummary health_;
  Publisher<swiftlet_msgs::msg::Telemetry> telemetry_;
};

const RegisterComponent<TelemetryComponent> kRegistered{
    "telemetry", "all that matters of the vehicle in 200 bytes, five times a second"};

}  // namespace
}  // namespace swiftlet
