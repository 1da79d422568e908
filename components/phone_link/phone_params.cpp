// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/phone_link/phone_params.hpp"

#include <fmt/format.h>

#include <cmath>

namespace swiftlet {
namespace {

void read_address(const Config& config, const char* key, std::optional<IpAddress>& address) {
  std::string text;
  config.read(key, text);
  if (text.empty()) return;
  address = parse_address(text);
  if (!address) {
    config.fail(key, fmt::format("'{}' is no IPv4 address such as 192.168.42.129", text));
  }
}

void read_json(const Config& config, JsonPolicy& policy) {
  std::string text = "refused";
  config.read("json", text);
  if (text == "refused") {
    policy = JsonPolicy::kRefused;
  } else if (text == "checked") {
    policy = JsonPolicy::kChecked;
  } else if (text == "any") {
    policy = JsonPolicy::kAny;
  } else {
    config.fail("json", fmt::format("'json' is refused, checked or any, not '{}'", text));
  }
}

void read_camera(const Config& config, FrameAnchor::Pose& camera) {
  config.read("position", camera.position);
  if (config.has("roll_pitch_yaw") && config.has("quaternion")) {
    config.fail("quaternion", "either 'roll_pitch_yaw' or 'quaternion', not both");
  }
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();
  config.read("roll_pitch_yaw", angles);
  camera.attitude = Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
                    Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
                    Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX());
  std::vector<double> quaternion;
  config.read("quaternion", quaternion);
  if (quaternion.empty()) return;
  if (quaternion.size() != 4) config.fail("quaternion", "'quaternion' has four numbers, w last");
  const Eigen::Quaterniond q(quaternion[3], quaternion[0], quaternion[1], quaternion[2]);
  if (std::abs(q.norm() - 1.0) > 1e-3) {
    config.fail("quaternion", "'quaternion' must have the length 1; its order is x, y, z, w");
  }
  camera.attitude = q.normalized();
}

void read_frame(const Config& config, FrameAnchor::Params& frame, int& start_poses) {
  read_camera(config.child("camera"), frame.camera);
  std::string up = "z";
  config.read("up_axis", up);
  if (up != "y" && up != "z") config.fail("up_axis", "'up_axis' is y or z");
  frame.y_is_up = up == "y";
  const Config start = config.child("start");
  start.read("position", frame.start_position);
  start.read("yaw", frame.start_yaw);
  start.read("poses", start_poses, {1, 10000});
}

void read_covariance(const Config& config, PhoneStream::Covariance& covariance) {
  Eigen::Vector3d position = covariance.diagonal().head<3>().cwiseSqrt();
  double tilt = std::sqrt(covariance(3, 3));
  double yaw = std::sqrt(covariance(5, 5));
  config.read("position_stddev", position, kPositive);
  config.read("tilt_stddev", tilt, kPositive);
  config.read("yaw_stddev", yaw, kPositive);
  Eigen::Matrix<double, 6, 1> stddev;
  stddev << position, tilt, tilt, yaw;
  covariance = stddev.cwiseAbs2().asDiagonal();
}

void read_jump(const Config& config, JumpAbsorber::Params& jump) {
  config.read("max_speed", jump.max_speed, kPositive);
  config.read("max_turn_rate", jump.max_turn_rate, kPositive);
  config.read("sigmas", jump.sigmas, kNotNegative);
  config.read("confirmations", jump.confirmations, {1, 100});
  config.read("follow_speed", jump.follow_speed, kNotNegative);
  config.read("follow_turn_rate", jump.follow_turn_rate, kNotNegative);
}

}  // namespace

PhoneLinkParams read_phone_link(const Config& config) {
  PhoneLinkParams params;
  std::optional<IpAddress> bind = params.bind.address;
  read_address(config, "bind", bind);
  params.bind.address = *bind;
  int port = params.bind.port;
  config.read("port", port, {1, 65535});
  params.bind.port = static_cast<std::uint16_t>(port);

  PhoneStream::Params& stream = params.stream;
  read_address(config, "sender", stream.sender.only_from);
  config.read("any_sender", stream.sender.any_sender);
  config.read("sender_silence", stream.sender.silence, {0.1, 3600.0});
  read_json(config, stream.json);
  config.read("max_age", stream.max_age, {0.001, 10.0});
  const Config clock = config.child("clock");
  clock.read("window", stream.clock.window, {1.0, 3600.0});
  clock.read("max_skew", stream.clock.max_skew, {0.0, 0.01});
  clock.read("assumed_latency", stream.clock.assumed_latency, {0.0, 1.0});
  if (stream.clock.assumed_latency >= stream.max_age) {
    clock.fail("assumed_latency",
               "'assumed_latency' must be below 'max_age', or all poses are late");
  }
  clock.read("step", stream.clock.step, {0.01, 10.0});
  clock.read("step_after", stream.clock.step_after, {0.1, 600.0});
  read_frame(config, stream.frame, stream.start_poses);
  read_covariance(config, stream.covariance);
  read_jump(config.child("jump"), stream.jump);
  return params;
}

}  // namespace swiftlet
