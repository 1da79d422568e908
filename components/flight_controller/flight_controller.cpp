// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "components/conversions.hpp"
#include "components/setpoint_message.hpp"
#include "components/topics.hpp"
#include "components/vehicle_model.hpp"
#include "control/flight_loop.hpp"

namespace swiftlet {
namespace {

constexpr Range kTimeout{0.001, 1.0};       // [s]
constexpr Range kLongTimeout{0.001, 60.0};  // [s]

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
  FlightLoop::Params& loop = params.loop;
  config.read("setpoint_timeout", loop.setpoint_timeout, kTimeout);
  config.read("estimate_timeout", loop.estimate_timeout, kTimeout);
  config.read("inertial_timeout", loop.inertial_timeout, kTimeout);
  config.read("velocity_timeout", loop.velocity_timeout, kLongTimeout);
  if (loop.inertial_timeout < loop.estimate_timeout) {
    config.fail("inertial_timeout", "'inertial_timeout' must not be below 'estimate_timeout'");
  }
  if (loop.velocity_timeout < loop.inertial_timeout) {
    config.fail("velocity_timeout", "'velocity_timeout' must not be below 'inertial_timeout'");
  }
  config.read("abandoned_timeout", loop.abandoned.timeout, kLongTimeout);
  config.read("landing_speed", loop.landing_speed, {0.05, 5.0});
  config.read("braking_acceleration", loop.abandoned.braking.acceleration, {0.1, 10.0});
  config.read("ground_range", loop.sonar.ground_range, {0.01, 10.0});
  config.read("sinking_thrust_to_weight", loop.sinking_thrust_to_weight, {0.5, 1.0});
  config.read("control_every", params.control_every, {1, 100});
  return params;
}

bool is_fallback(FlightLoop::Behaviour behaviour) {
  using Behaviour = FlightLoop::Behaviour;
  return behaviour != Behaviour::kMotorsOff && behaviour != Behaviour::kTracking;
}

/// From setpoint and odometry to motors, with the SE(3) controller of seed 000, paced by the IMU.
class FlightController : public Component {
 public:
  explicit FlightController(const ComponentContext& context)
      : Component(context), params_(read_params(parameters())), loop_(params_.loop, params_.model) {
    motors_ = advertise(topic::motors);
    subscribe(topic::odometry, [this](const nav_msgs::msg::Odometry& odometry) {
      const Time stamp = from_msg(odometry.header().stamp());
      odometry_offset_ = strange_offset(stamp, params_.loop.estimate_timeout);
      loop_.set_estimate(stamp, from_msg(odometry));
    });
    subscribe(topic::setpoint, [this](const swiftlet_msgs::msg::Setpoint& setpoint) {
      const Time stamp = from_msg(setpoint.header().stamp());
      setpoint_offset_ = strange_offset(stamp, params_.loop.setpoint_timeout);
      if (!guard_flies()) follow(setpoint);
    });
    // While the guard says what to fly, the commander is not heard.
    subscribe(
        topic::guard_setpoint,
        [this](const swiftlet_msgs::msg::Setpoint& setpoint) {
          guard_heard_ = now();
          follow(setpoint);
        },
        Need::kOptional);
    subscribe(topic::range_down, [this](const sensor_msgs::msg::Range& range) {
      loop_.set_range_down(range.range());
    });
    subscribe(topic::imu0, [this](const sensor_msgs::msg::Imu& imu) {
      if (++samples_ % params_.control_every == 0) control(imu);
    });
    set_changeable_parameters(
        {{"position_gain", "velocity_gain", "attitude_gain", "rate_gain", "integral_gain",
          "max_tilt", "landing_speed", "braking_acceleration"},
         {"setpoint_timeout", "estimate_timeout", "inertial_timeout", "velocity_timeout",
          "abandoned_timeout", "ground_range", "sinking_thrust_to_weight"},
         [this] { return behaviour_ != FlightLoop::Behaviour::kMotorsOff; },
         [this](const Config& changed) {
           const Params params = read_params(changed);
           loop_.set_params(params.loop);
           params_ = params;
         }});
  }

 private:
  /// It speaks as often as the commander, and when it ends, he is to be heard before he counts as
  /// silent.
  bool guard_flies() const {
    return guard_heard_ && to_seconds(now() - *guard_heard_) <= 0.5 * params_.loop.setpoint_timeout;
  }

  void follow(const swiftlet_msgs::msg::Setpoint& setpoint) {
    loop_.set_setpoint({from_msg(setpoint.header().stamp()), setpoint_kind_of(setpoint.kind()),
                        reference_of(setpoint)});
  }

  /// By how much a stamp is off the IMU's clock [s], where that is too much for it to be flown.
  std::optional<double> strange_offset(Time stamp, double timeout) const {
    if (!imu_time_ || Freshness::plausible(stamp, *imu_time_, timeout)) return std::nullopt;
    return to_seconds(stamp - *imu_time_);
  }

  std::string obstacle() const override {
    for (const auto& [topic, offset] : {std::pair{topic::setpoint.name, setpoint_offset_},
                                        std::pair{topic::odometry.name, odometry_offset_}}) {
      if (!offset) continue;
      return fmt::format(
          "{}: its stamps are {:.2f} s {} the IMU's; are the clocks of all hosts synchronised?",
          topic, std::abs(*offset), *offset > 0.0 ? "ahead of" : "behind");
    }
    return "";
  }

  void control(const sensor_msgs::msg::Imu& imu) {
    const Time time = from_msg(imu.header().stamp());
    imu_time_ = time;
    const FlightLoop::Output output = loop_.step(time, from_msg(imu));
    tell(output);
    command_.stamp(to_msg(time));
    command_.armed(output.armed());
    std::copy_n(output.rotor_thrusts.data(), 4, command_.thrust().begin());
    motors_.publish(command_);
  }

  /// Each change, with its reason; what is not as planned as a warning.
  void tell(const FlightLoop::Output& output) {
    if (output.motors_off_refused && !refusal_told_) {
      log()->warn("\"motors off\" from a commander that was away: not obeyed in the air");
    }
    refusal_told_ = output.motors_off_refused || (refusal_told_ && is_fallback(behaviour_));
    if (output.behaviour == behaviour_) return;
    behaviour_ = output.behaviour;
    log()->log(is_fallback(behaviour_) ? spdlog::level::warn : spdlog::level::info, "{}",
               describe(output));
  }

  Params params_;
  FlightLoop loop_;
  std::int64_t samples_ = 0;
  std::optional<Time> imu_time_;
  std::optional<Time> guard_heard_;
  std::optional<double> setpoint_offset_;  // of the last, where it is strange
  std::optional<double> odometry_offset_;
  bool refusal_told_ = false;
  FlightLoop::Behaviour behaviour_ = FlightLoop::Behaviour::kMotorsOff;
  swiftlet_msgs::msg::MotorCommand command_;
  Publisher<swiftlet_msgs::msg::MotorCommand> motors_;
};

const RegisterComponent<FlightController> kRegistered{
    "flight_controller", "from setpoint and odometry to motors, by the SE(3) controller"};

}  // namespace
}  // namespace swiftlet
