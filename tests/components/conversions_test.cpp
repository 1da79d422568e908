// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/conversions.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector3d;
using namespace std::chrono_literals;

struct Random {
  std::mt19937 engine{11};
  std::normal_distribution<double> normal;
  Vector3d vector() { return {normal(engine), normal(engine), normal(engine)}; }
};

TEST(TimeMessage, RoundTripsToTheNanosecond) {
  std::mt19937_64 random(1);
  // sec is an int32: from 1901 to 2038.
  std::uniform_int_distribution<std::int64_t> any(-2'147'483'648LL * 1'000'000'000,
                                                  2'147'483'647LL * 1'000'000'000);
  for (int k = 0; k < 1000; ++k) {
    const Time time{Duration(any(random))};
    const auto message = to_msg(time);
    EXPECT_LT(message.nanosec(), 1'000'000'000u);
    EXPECT_EQ(from_msg(message), time);
  }
}

TEST(TimeMessage, BeforeTheEpochIsRoundedDownAsRos2Does) {
  EXPECT_EQ(to_msg(Time(-1ns)).sec(), -1);
  EXPECT_EQ(to_msg(Time(-1ns)).nanosec(), 999'999'999u);
  EXPECT_EQ(to_msg(Time(-2s)).sec(), -2);
  EXPECT_EQ(to_msg(Time(-2s)).nanosec(), 0u);
  EXPECT_EQ(to_msg(Time(1500ms)).sec(), 1);
  EXPECT_EQ(to_msg(Time(1500ms)).nanosec(), 500'000'000u);
}

TEST(GeometryMessages, KeepEveryComponentInItsPlace) {
  const auto point = to_point({1, 2, 3});
  EXPECT_EQ(point.x(), 1);
  EXPECT_EQ(point.y(), 2);
  EXPECT_EQ(point.z(), 3);
  const auto vector = to_vector3({4, 5, 6});
  EXPECT_EQ(vector.x(), 4);
  EXPECT_EQ(vector.y(), 5);
  EXPECT_EQ(vector.z(), 6);
  // Eigen's constructor takes w first, its storage and the message have it last.
  const auto quaternion = to_msg(Eigen::Quaterniond(0.1, 0.2, 0.3, 0.4));
  EXPECT_EQ(quaternion.w(), 0.1);
  EXPECT_EQ(quaternion.x(), 0.2);
  EXPECT_EQ(quaternion.y(), 0.3);
  EXPECT_EQ(quaternion.z(), 0.4);
  EXPECT_EQ(from_msg(point), Vector3d(1, 2, 3));
  EXPECT_EQ(from_msg(vector), Vector3d(4, 5, 6));
  EXPECT_EQ(from_msg(quaternion).coeffs(), Eigen::Quaterniond(0.1, 0.2, 0.3, 0.4).coeffs());
  const auto pose = to_pose({1, 2, 3}, Eigen::Quaterniond(0.1, 0.2, 0.3, 0.4));
  EXPECT_EQ(from_msg(pose.position()), Vector3d(1, 2, 3));
  EXPECT_EQ(from_msg(pose.orientation()).w(), 0.1);
}

TEST(OdometryMessage, HasTheVelocityInTheBody) {
  // Nose to the north, moving north: forwards for the body.
  RigidBodyState state;
  state.p_WB = Vector3d(1, 2, 3);
  state.q_WB = from_yaw(M_PI / 2);
  state.v_WB_W = Vector3d(0, 2, 0);
  state.w_WB_B = Vector3d(0.1, 0.2, 0.3);
  const auto odometry = to_odometry(Time(5s), state);
  EXPECT_NEAR(odometry.twist().twist().linear().x(), 2.0, 1e-12);
  EXPECT_NEAR(odometry.twist().twist().linear().y(), 0.0, 1e-12);
  EXPECT_EQ(odometry.twist().twist().angular().z(), 0.3);
  EXPECT_EQ(odometry.header().frame_id(), "map");
  EXPECT_EQ(odometry.child_frame_id(), "base_link");
  EXPECT_EQ(from_msg(odometry.header().stamp()), Time(5s));
}

TEST(OdometryMessage, RoundTripsAnyState) {
  Random random;
  for (int k = 0; k < 100; ++k) {
    const RigidBodyState state{random.vector(), exp_so3(random.vector()), random.vector(),
                               random.vector()};
    const RigidBodyState back = from_msg(to_odometry(Time(1s), state));
    EXPECT_EQ(back.p_WB, state.p_WB);
    EXPECT_EQ(back.q_WB.coeffs(), state.q_WB.coeffs());
    EXPECT_LT((back.v_WB_W - state.v_WB_W).norm(), 1e-12);
    EXPECT_EQ(back.w_WB_B, state.w_WB_B);
  }
}

TEST(OdometryMessage, WhatIsBrokenStaysVisiblyBroken) {
  nav_msgs::msg::Odometry odometry;  // its quaternion is all zero
  EXPECT_EQ(from_msg(odometry).q_WB.norm(), 0.0);
  odometry.pose().pose().position().x(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(from_msg(odometry).p_WB.allFinite());
}

TEST(ImuMessage, GivesRateAndSpecificForce) {
  sensor_msgs::msg::Imu imu;
  imu.angular_velocity(to_vector3({0.1, 0.2, 0.3}));
  imu.linear_acceleration(to_vector3({1, 2, 9.8}));
  EXPECT_EQ(from_msg(imu).angular_velocity, Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(from_msg(imu).specific_force, Vector3d(1, 2, 9.8));
}

TEST(SetpointMessage, RoundTripsEveryFieldOfTheReference) {
  Random random;
  const FlatReference r{random.vector(),
                        random.vector(),
                        random.vector(),
                        random.vector(),
                        random.vector(),
                        0.7,
                        -0.2,
                        0.05};
  swiftlet_msgs::msg::Setpoint message;
  set_reference(r, message);
  const FlatReference back = reference_of(message);
  EXPECT_EQ(back.position, r.position);
  EXPECT_EQ(back.velocity, r.velocity);
  EXPECT_EQ(back.acceleration, r.acceleration);
  EXPECT_EQ(back.jerk, r.jerk);
  EXPECT_EQ(back.snap, r.snap);
  EXPECT_EQ(back.yaw, r.yaw);
  EXPECT_EQ(back.yaw_rate, r.yaw_rate);
  EXPECT_EQ(back.yaw_acceleration, r.yaw_acceleration);
  EXPECT_EQ(message.position().y(), r.position.y());
  EXPECT_EQ(message.snap().z(), r.snap.z());
}

}  // namespace
}  // namespace swiftlet
