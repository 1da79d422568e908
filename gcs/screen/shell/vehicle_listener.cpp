// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/shell/vehicle_listener.hpp"

#include "components/battery_message.hpp"
#include "gcs/screen/shell/reports.hpp"

namespace swiftlet::screen {

VehicleListener::VehicleListener(const ComponentContext& context) : Component(context) {
  subscribe(topic::vehicle_status, [this](const swiftlet_msgs::msg::VehicleStatus& status) {
    model_.hear(report_of(status), now());
  });
  subscribe(topic::mission_state, [this](const swiftlet_msgs::msg::MissionState& state) {
    model_.hear(report_of(state), now());
    heard(state);
  });
  subscribe(
      topic::vehicle_limits,
      [this](const swiftlet_msgs::msg::FlightLimits& limits) {
        model_.hear(report_of(limits), now());
      },
      Need::kOptional);
  subscribe(topic::battery, [this](const sensor_msgs::msg::BatteryState& battery) {
    model_.hear(from_msg(battery), now());
  });
  subscribe(topic::guard_status, [this](const swiftlet_msgs::msg::GuardStatus& guard) {
    model_.hear(GuardReport{guard.acting(), guard.reason()}, now());
  });
  subscribe(topic::component_status, [this](const swiftlet_msgs::msg::ComponentStatus& status) {
    if (!status.active()) return;
    model_.hear_component(status.component_name(), {status.problems()}, now());
  });
}

}  // namespace swiftlet::screen
