// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/reference_merge.hpp"

#include <algorithm>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {

using Eigen::Vector3d;

void ReferenceMerge::begin(Time start, const FlatReference& flown, const FlatReference& wanted,
                           const ReferenceLimits& braking, const ReferenceLimits& undoing) {
  *this = {};
  end_ = start;
  FlatReference difference;
  difference.position = flown.position - wanted.position;
  difference.velocity = flown.velocity - wanted.velocity;
  difference.acceleration = flown.acceleration - wanted.acceleration;
  difference.yaw = wrap_angle(flown.yaw - wanted.yaw);
  difference.yaw_rate = flown.yaw_rate - wanted.yaw_rate;
  difference.yaw_acceleration = flown.yaw_acceleration - wanted.yaw_acceleration;

  const auto brake = FlightReference::brake(start, difference, braking);
  if (!brake.ok()) return;
  const FlatReference rest = brake->final();
  const ReferenceLimits turning{undoing.velocity, undoing.yaw_acceleration, undoing.yaw_jerk};
  const auto undo =
      FlightReference::move(start, Vector3d::Zero(), Vector3d(-rest.position), 0.0, undoing);
  const auto heading =
      FlightReference::move(start, Vector3d::Zero(), Vector3d(-rest.yaw, 0.0, 0.0), 0.0, turning);
  if (!undo.ok() || !heading.ok()) return;
  brake_ = *brake;
  undo_ = *undo;
  heading_ = *heading;
  end_ = std::max({brake_.end(), undo_.end(), heading_.end()});
}

FlatReference ReferenceMerge::apply(Time time, const FlatReference& wanted) const {
  if (finished(time)) return wanted;
  FlatReference reference = wanted;
  for (const FlightReference* part : {&brake_, &undo_}) {
    const FlatReference difference = part->at(time);
    reference.position += difference.position;
    reference.velocity += difference.velocity;
    reference.acceleration += difference.acceleration;
    reference.jerk += difference.jerk;
    reference.snap += difference.snap;
    reference.yaw += difference.yaw;
    reference.yaw_rate += difference.yaw_rate;
    reference.yaw_acceleration += difference.yaw_acceleration;
  }
  const FlatReference turn = heading_.at(time);
  reference.yaw += turn.position.x();
  reference.yaw_rate += turn.velocity.x();
  reference.yaw_acceleration += turn.acceleration.x();
  return reference;
}

}  // namespace swiftlet
