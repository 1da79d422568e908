// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/conversions.hpp"

namespace swiftlet {

geometry_msgs::msg::Point to_point(const Eigen::Vector3d& v) {
  geometry_msgs::msg::Point point;
  point.x(v.x());
  point.y(v.y());
  point.z(v.z());
  return point;
}

geometry_msgs::msg::Vector3 to_vector3(const Eigen::Vector3d& v) {
  geometry_msgs::msg::Vector3 vector;
  vector.x(v.x());
  vector.y(v.y());
  vector.z(v.z());
  return vector;
}

geometry_msgs::msg::Quaternion to_msg(const Eigen::Quaterniond& q) {
  geometry_msgs::msg::Quaternion quaternion;
  quaternion.x(q.x());
  quaternion.y(q.y());
  quaternion.z(q.z());
  quaternion.w(q.w());
  return quaternion;
}

geometry_msgs::msg::Pose to_pose(const Eigen::Vector3d& p, const Eigen::Quaterniond& q) {
  geometry_msgs::msg::Pose pose;
  pose.position(to_point(p));
  pose.orientation(to_msg(q));
  return pose;
}

Eigen::Vector3d from_msg(const geometry_msgs::msg::Point& p) {
  return {p.x(), p.y(), p.z()};
}
Eigen::Vector3d from_msg(const geometry_msgs::msg::Vector3& v) {
  return {v.x(), v.y(), v.z()};
}
Eigen::Quaterniond from_msg(const geometry_msgs::msg::Quaternion& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

nav_msgs::msg::Odometry to_odometry(Time time, const RigidBodyState& state) {
  nav_msgs::msg::Odometry odometry;
  odometry.header(make_header(time, "map"));
  odometry.child_frame_id("base_link");
  odometry.pose().pose(to_pose(state.p_WB, state.q_WB));
  odometry.twist().twist().linear(to_vector3(state.q_WB.conjugate() * state.v_WB_W));
  odometry.twist().twist().angular(to_vector3(state.w_WB_B));
  return odometry;
}

RigidBodyState from_msg(const nav_msgs::msg::Odometry& odometry) {
  RigidBodyState state;
  state.p_WB = from_msg(odometry.pose().pose().position());
  state.q_WB = from_msg(odometry.pose().pose().orientation());
  state.v_WB_W = state.q_WB * from_msg(odometry.twist().twist().linear());
  state.w_WB_B = from_msg(odometry.twist().twist().angular());
  return state;
}

ImuSample from_msg(const sensor_msgs::msg::Imu& imu) {
  return {from_msg(imu.angular_velocity()), from_msg(imu.linear_acceleration())};
}

void set_reference(const FlatReference& reference, swiftlet_msgs::msg::Setpoint& setpoint) {
  setpoint.position(to_point(reference.position));
  setpoint.velocity(to_vector3(reference.velocity));
  setpoint.acceleration(to_vector3(reference.acceleration));
  setpoint.jerk(to_vector3(reference.jerk));
  setpoint.snap(to_vector3(reference.snap));
  setpoint.yaw(reference.yaw);
  setpoint.yaw_rate(reference.yaw_rate);
  setpoint.yaw_acceleration(reference.yaw_acceleration);
}

FlatReference reference_of(const swiftlet_msgs::msg::Setpoint& setpoint) {
  FlatReference reference;
  reference.position = from_msg(setpoint.position());
  reference.velocity = from_msg(setpoint.velocity());
  reference.acceleration = from_msg(setpoint.acceleration());
  reference.jerk = from_msg(setpoint.jerk());
  reference.snap = from_msg(setpoint.snap());
  reference.yaw = setpoint.yaw();
  reference.yaw_rate = setpoint.yaw_rate();
  reference.yaw_acceleration = setpoint.yaw_acceleration();
  return reference;
}

}  // namespace swiftlet
