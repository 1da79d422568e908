// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "components/conversions.hpp"
#include "components/topics.hpp"
#include "components/vehicle_model.hpp"
#include "control/flight_loop.hpp"

namespace swiftlet {
namespace {

struct Params {
  FlightLoop::Params loop;
  QuadrotorModel model;
  int control_every = 4;  ///< IMU samples: 250 Hz of a 1 kHz IMU
};

Params read_params(const Config& config) {
  Params params;
  read_vehicle_model(config.child("model"), params.model);
  Se3Controller::Params& gains = params.loop.controller;
  config.read("position_gain", gains.position_gain, kPositive);
  config.read("velocity_gain", gains.velocity_gain, kPositive);
  config.read("attitude_gain", gains.attitude_gain, kPositive);
  config.read("rate_gain", gains.rate_gain, kPositive);
  config.read("integral_gain", gains.integral_gain, kNotNegative);
  config.read("max_tilt", gains.max_tilt, {0.05, 1.39});
  config.read("setpoint_timeout", params.loop.setpoint_timeout, kPositive);
  config.read("estimate_timeout", params.loop.estimate_timeout, kPositive);
  config.read("sinking_thrust_to_weight", params.loop.sinking_thrust_to_weight, {0.5, 1.0});
  config.read("control_every", params.control_every, {1, 100});
  return params;
}

const char* describe(FlightLoop::Behaviour behaviour) {
  switch (behaviour) {
    case FlightLoop::Behaviour::kMotorsOff:
      return "motors off";
    case FlightLoop::Behaviour::kTracking:
      return "tracking the setpoint";
    case FlightLoop::Behaviour::kLevel:
      return "level and sinking, as asked";
    case FlightLoop::Behaviour::kStaleSetpoint:
      return "no fresh setpoint: keeping level";
    case FlightLoop::Behaviour::kStaleEstimate:
      return "no fresh odometry: level and sinking";
  }
  return "unknown";
}

/// From setpoint and odometry to motors, with the SE(3) controller of seed 000, paced by the IMU.
class FlightController : public Component {
 public:
  explicit FlightController(const ComponentContext& context)
      : Component(context), params_(read_params(parameters())), loop_(params_.loop, params_.model) {
    motors_ = advertise(topic::motors);
    subscribe(topic::odometry, [this](const nav_msgs::msg::Odometry& odometry) {
      loop_.set_estimate(from_msg(odometry.header().stamp()), from_msg(odometry));
    });
    subscribe(topic::setpoint, [this](const swiftlet_msgs::msg::Setpoint& setpoint) {
      loop_.set_setpoint(
          {from_msg(setpoint.header().stamp()), kind_of(setpoint.kind()), reference_of(setpoint)});
    });
    subscribe(topic::imu0, [this](const sensor_msgs::msg::Imu& imu) {
      if (++samples_ % params_.control_every == 0) control(imu);
    });
  }

 private:
  static SetpointKind kind_of(std::uint8_t kind) {
    using namespace swiftlet_msgs::msg::Setpoint_Constants;
    if (kind == TRACK) return SetpointKind::kTrack;
    return kind == LEVEL ? SetpointKind::kLevel : SetpointKind::kMotorsOff;
  }

  void control(const sensor_msgs::msg::Imu& imu) {
    const Time time = from_msg(imu.header().stamp());
    const FlightLoop::Output output = loop_.step(time, from_msg(imu).angular_velocity);
    if (output.behaviour != behaviour_) {
      behaviour_ = output.behaviour;
      log()->info("{}", describe(behaviour_));
    }
    command_.stamp(to_msg(time));
    command_.armed(behaviour_ != FlightLoop::Behaviour::kMotorsOff);
    std::copy_n(output.rotor_thrusts.data(), 4, command_.thrust().begin());
    motors_.publish(command_);
  }

  Params params_;
  FlightLoop loop_;
  std::int64_t samples_ = 0;
  FlightLoop::Behaviour behaviour_ = FlightLoop::Behaviour::kMotorsOff;
  swiftlet_msgs::msg::MotorCommand command_;
  Publisher<swiftlet_msgs::msg::MotorCommand> motors_;
};

const RegisterComponent<FlightController> kRegistered{
    "flight_controller", "from setpoint and odometry to motors, by the SE(3) controller"};

}  // namespace
}  // namespace swiftlet
