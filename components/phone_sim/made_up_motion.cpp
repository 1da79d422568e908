// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/phone_sim/made_up_motion.hpp"

#include <cmath>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

constexpr double kHeight = 1.0;  // [m]
constexpr double kRadius = 1.0;  // [m]
constexpr double kSpeed = 0.5;   // [m/s]

}  // namespace

VehicleTruth made_up_truth(MadeUpMotion motion, Time time) {
  VehicleTruth truth;
  truth.time = time;
  truth.body.p_WB.z() = kHeight;
  if (motion == MadeUpMotion::kHover) return truth;
  // The centre is to the left of the start.
  const double angle = kSpeed / kRadius * to_seconds(time);
  truth.body.p_WB.x() = kRadius * std::sin(angle);
  truth.body.p_WB.y() = kRadius * (1.0 - std::cos(angle));
  truth.body.q_WB = from_yaw(angle);
  truth.body.v_WB_W = truth.body.q_WB * Eigen::Vector3d(kSpeed, 0.0, 0.0);
  truth.body.w_WB_B.z() = kSpeed / kRadius;
  return truth;
}

}  // namespace swiftlet
