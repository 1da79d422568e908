// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/planner/trajectory_message.hpp"

#include <algorithm>

#include "components/conversions.hpp"

namespace swiftlet {
namespace {

using Coefficients = std::array<double, kCoefficients>;

Coefficients to_array(const Polynomial& polynomial) {
  Coefficients coefficients;
  std::copy_n(polynomial.data(), kCoefficients, coefficients.begin());
  return coefficients;
}

Polynomial to_polynomial(const Coefficients& coefficients) {
  return Eigen::Map<const Polynomial>(coefficients.data());
}

}  // namespace

swiftlet_msgs::msg::Trajectory to_msg(const Trajectory& trajectory, Time goal_stamp) {
  swiftlet_msgs::msg::Trajectory message;
  message.header(make_header(trajectory.start(), "map"));
  message.goal_stamp(to_msg(goal_stamp));
  message.status(swiftlet_msgs::msg::Trajectory_Constants::PLANNED);
  for (const TrajectorySegment& segment : trajectory.segments()) {
    swiftlet_msgs::msg::TrajectorySegment item;
    item.duration(segment.duration_s);
    item.x(to_array(segment.coefficients[kX]));
    item.y(to_array(segment.coefficients[kY]));
    item.z(to_array(segment.coefficients[kZ]));
    item.yaw(to_array(segment.coefficients[kYaw]));
    message.segments().push_back(item);
  }
  return message;
}

swiftlet_msgs::msg::Trajectory no_trajectory_msg(Time now, Time goal_stamp, std::uint8_t status,
                                                 const std::string& failure,
                                                 const std::string& reason) {
  swiftlet_msgs::msg::Trajectory message;
  message.header(make_header(now, "map"));
  message.goal_stamp(to_msg(goal_stamp));
  message.status(status);
  message.failure(failure);
  message.reason(reason);
  return message;
}

Trajectory from_msg(const swiftlet_msgs::msg::Trajectory& message) {
  if (message.status() != swiftlet_msgs::msg::Trajectory_Constants::PLANNED) return {};
  std::vector<TrajectorySegment> segments;
  for (const auto& item : message.segments()) {
    TrajectorySegment segment;
    segment.duration_s = item.duration();
    segment.coefficients = {to_polynomial(item.x()), to_polynomial(item.y()),
                            to_polynomial(item.z()), to_polynomial(item.yaw())};
    segments.push_back(segment);
  }
  return Trajectory(from_msg(message.header().stamp()), std::move(segments));
}

}  // namespace swiftlet
