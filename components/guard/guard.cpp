// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "components/conversions.hpp"
#include "components/setpoint_message.hpp"
#include "components/surroundings/surroundings.hpp"
#include "components/topics.hpp"
#include "control/flight_guard.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kStatusPeriod = 100ms;

FlightGuard::Params read_params(const Config& config) {
  FlightGuard::Params params;
  config.read("vehicle_radius", params.vehicle_radius, kPositive);
  config.read("margin", params.margin, kNotNegative);
  config.read("max_speed", params.max_speed, kPositive);
  config.read("max_gap", params.max_gap, kPositive);
  config.read("fence_radius", params.fence_radius, kNotNegative);
  config.read("fence_height", params.fence_height, kNotNegative);
  config.read("braking_acceleration", params.braking.acceleration, {0.5, 10.0});
  return params;
}

/// A second pair of eyes, in a process of its own: it looks at each setpoint as it comes, and flies
/// instead of it where that cannot be right.
class Guard : public Component {
 public:
  explicit Guard(const ComponentContext& context)
      : Component(context), guard_(read_params(parameters())) {
    setpoint_ = advertise(topic::guard_setpoint);
    status_ = advertise(topic::guard_status);
    subscribe(topic::odometry, [this](const nav_msgs::msg::Odometry& odometry) {
      guard_.set_estimate(from_msg(odometry));
      surroundings_.hear(odometry);
      look_around();
    });
    subscribe(
        topic::tf_static,
        [this](const tf2_msgs::msg::TFMessage& mounts) { surroundings_.hear(mounts); },
        Need::kOptional);
    subscribe(topic::scan, [this](const sensor_msgs::msg::LaserScan& scan) {
      surroundings_.hear(scan);
      look_around();
    });
    subscribe(topic::vehicle_status, [this](const swiftlet_msgs::msg::VehicleStatus& status) {
      if (status.armed()) guard_.set_home(from_msg(status.takeoff_point()));
    });
    subscribe(topic::setpoint,
              [this](const swiftlet_msgs::msg::Setpoint& setpoint) { check(setpoint); });
    every(kStatusPeriod, [this](Time now) { tell(now); });
  }

 private:
  void look_around() {
    if (auto seen = surroundings_.take()) {
      guard_.set_obstacles(std::move(seen->obstacles), seen->time);
    }
  }

  void check(const swiftlet_msgs::msg::Setpoint& message) {
    const bool was_acting = guard_.acting();
    const auto instead = guard_.check({from_msg(message.header().stamp()),
                                       setpoint_kind_of(message.kind()), reference_of(message)});
    if (instead) {
      swiftlet_msgs::msg::Setpoint setpoint;
      setpoint.header(make_header(instead->time, frame::kMap));
      setpoint.kind(swiftlet_msgs::msg::Setpoint_Constants::TRACK);
      set_reference(instead->reference, setpoint);
      setpoint_.publish(setpoint);
    }
    if (guard_.acting() == was_acting) return;
    if (guard_.acting()) {
      log()->warn("stops the vehicle: {}", guard_.reason());
    } else {
      log()->info("lets the commander fly again");
    }
    tell(now());
  }

  void tell(Time now) {
    swiftlet_msgs::msg::GuardStatus status;
    status.header(make_header(now, frame::kMap));
    status.acting(guard_.acting());
    status.reason(guard_.reason());
    status_.publish(status);
  }

  FlightGuard guard_;
  Surroundings surroundings_;
  Publisher<swiftlet_msgs::msg::Setpoint> setpoint_;
  Publisher<swiftlet_msgs::msg::GuardStatus> status_;
};

const RegisterComponent<Guard> kRegistered{
    "guard", "watches setpoints and obstacles, and stops the vehicle where it must"};

}  // namespace
}  // namespace swiftlet
