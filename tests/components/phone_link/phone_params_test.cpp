// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/phone_link/phone_params.hpp"

#include <gmock/gmock.h>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

PhoneLinkParams read(const std::string& yaml) {
  const Config config = Config::parse(yaml, "phone.yaml");
  PhoneLinkParams params = read_phone_link(config);
  config.finish();
  return params;
}
void expect_refused(const std::string& yaml, const std::string& problem) {
  EXPECT_THAT([&] { read(yaml); }, ThrowsMessage<ConfigError>(HasSubstr(problem))) << yaml;
}

TEST(PhoneParams, LoopbackAndBinaryUnlessTold) {
  const PhoneLinkParams params = read("{}");
  EXPECT_EQ(to_string(params.bind), "127.0.0.1:8787");
  EXPECT_EQ(params.stream.json, JsonPolicy::kRefused);
  EXPECT_FALSE(params.stream.sender.any_sender);
  EXPECT_FALSE(params.stream.sender.only_from);
}

TEST(PhoneParams, TheCameraSitsWhereItIsSaid) {
  const auto angles = read("camera: {position: [0.1, 0, -0.02], roll_pitch_yaw: [0, 0, 1.5708]}");
  EXPECT_EQ(angles.stream.frame.camera.position, Eigen::Vector3d(0.1, 0.0, -0.02));
  EXPECT_NEAR(yaw_of(angles.stream.frame.camera.attitude), 1.5708, 1e-9);
  const auto quaternion = read("camera: {quaternion: [0, 0, 0.6, 0.8]}");
  EXPECT_NEAR(quaternion.stream.frame.camera.attitude.z(), 0.6, 1e-9);
  EXPECT_NEAR(quaternion.stream.frame.camera.attitude.w(), 0.8, 1e-9);
}

TEST(PhoneParams, WhatCannotBeIsRefusedWithTheReason) {
  expect_refused("bind: localhost", "IPv4");
  expect_refused("port: 0", "port");
  expect_refused("sender: 300.1.1.1", "IPv4");
  expect_refused("json: 'yes'", "refused, checked or any");
  expect_refused("up_axis: x", "y or z");
  expect_refused("camera: {quaternion: [0, 0, 1]}", "four numbers");
  expect_refused("camera: {quaternion: [0, 0, 1, 1]}", "length 1");
  expect_refused("camera: {quaternion: [0, 0, 0, 1], roll_pitch_yaw: [0, 0, 0]}", "not both");
  expect_refused("clock: {assumed_latency: 0.3}", "max_age");
  expect_refused("jump: {confirmations: 0}", "confirmations");
  expect_refused("max_aeg: 1", "max_age");
}

}  // namespace
}  // namespace swiftlet
