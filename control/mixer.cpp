// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/mixer.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "estimation/geometry/rigid_body.hpp"

namespace swiftlet {
namespace {

struct Interval {
  double low, high;
  double clamp(double value) const { return std::min(std::max(value, low), high); }
};

bool differs(double achieved, double asked, double scale) {
  return std::abs(achieved - asked) > 1e-9 * scale;
}

}  // namespace

Mixer::Mixer(const QuadrotorModel& model) : model_(model) {
  const bool usable = model.arm_length > 0.0 && model.torque_per_thrust > 0.0 &&
                      model.rotor_thrust_min >= 0.0 &&
                      model.rotor_thrust_max > model.rotor_thrust_min && model.mass > 0.0 &&
                      std::isfinite(model.arm_length + model.torque_per_thrust +
                                    model.rotor_thrust_max + model.mass);
  if (!usable) throw std::invalid_argument("mixer: the vehicle model has no thrust to give");
}

MixerOutput Mixer::mix(const Wrench& wrench) const {
  const double d = model_.arm_length;
  const double c = model_.torque_per_thrust;
  const double f_min = model_.rotor_thrust_min;
  const double f_max = model_.rotor_thrust_max;

  MixerOutput output;
  Wrench asked = wrench;
  if (!std::isfinite(wrench.thrust) || !wrench.moment.allFinite()) {
    output.input_refused = true;
    asked = {model_.mass * kGravity, Eigen::Vector3d::Zero()};
  }

  // Half differences of the pairs: what roll and pitch need, whatever the sums are.
  const double half_range = 0.5 * (f_max - f_min);
  const Interval halves{-half_range, half_range};
  const double pitch = halves.clamp(asked.moment.y() / (2.0 * d));  // (f3 - f1) / 2
  const double roll = halves.clamp(asked.moment.x() / (2.0 * d));   // (f4 - f2) / 2

  // What that leaves to the sums of the pairs. Both intervals contain f_min + f_max.
  const Interval sum13{2.0 * (f_min + std::abs(pitch)), 2.0 * (f_max - std::abs(pitch))};
  const Interval sum24{2.0 * (f_min + std::abs(roll)), 2.0 * (f_max - std::abs(roll))};

  // Collective thrust for which some difference of the sums between zero and the one that yaw
  // asks for is possible. Each bound of the sum comes from one interval, or from the other and the
  // difference.
  const double yaw = asked.moment.z() / c;  // sum13 - sum24
  const Interval difference{std::min(yaw, 0.0), std::max(yaw, 0.0)};
  const double low = std::max(
      {sum13.low + sum24.low, 2.0 * sum13.low - difference.high, 2.0 * sum24.low + difference.low});
  const double high = std::min({sum13.high + sum24.high, 2.0 * sum13.high - difference.low,
                                2.0 * sum24.high + difference.high});
  const double thrust = Interval{low, high}.clamp(asked.thrust);

  // The difference nearest to what yaw asks for at that thrust: the sums are half of
  // thrust +- difference.
  const Interval possible{std::max(2.0 * sum13.low - thrust, thrust - 2.0 * sum24.high),
                          std::min(2.0 * sum13.high - thrust, thrust - 2.0 * sum24.low)};
  const double turned = difference.clamp(possible.clamp(yaw));

  const double half13 = 0.25 * (thrust + turned);
  const double half24 = 0.25 * (thrust - turned);
  const Eigen::Vector4d thrusts(half13 - pitch, half24 - roll, half13 + pitch, half24 + roll);
  output.rotor_thrusts = thrusts.cwiseMax(f_min).cwiseMin(f_max);

  const Eigen::Vector4d sums = allocation_matrix(model_) * output.rotor_thrusts;
  output.achieved = {sums(0), sums.tail<3>()};
  output.roll_pitch_limited = differs(sums(1), asked.moment.x(), d * f_max) ||
                              differs(sums(2), asked.moment.y(), d * f_max);
  output.thrust_limited = differs(sums(0), asked.thrust, f_max);
  output.yaw_limited = differs(sums(3), asked.moment.z(), c * f_max);
  return output;
}

}  // namespace swiftlet
