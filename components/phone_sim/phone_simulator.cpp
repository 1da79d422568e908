// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/phone_sim/phone_simulator.hpp"

#include <cmath>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

constexpr double kFrameSpread = 2.0;  // of the origin of the phone's frame [m]

}  // namespace

PhoneSimulator::PhoneSimulator(const Params& params, std::uint64_t seed)
    : params_(params), sensor_(params.sensor, RandomStream(seed, "phone")) {
  RandomStream random(seed, "phone frame");
  p_PW_ = kFrameSpread * random.normal3();
  yaw_PW_ = 2.0 * M_PI * random.uniform();
}

std::optional<DatagramBytes> PhoneSimulator::update(const VehicleTruth& truth) {
  const PhonePoseReading* reading = sensor_.update(truth);
  if (reading == nullptr) return std::nullopt;
  const PhonePose pose = pose_of(*reading);
  return params_.json ? encode_json(pose) : encode_binary(pose);
}

PhonePose PhoneSimulator::pose_of(const PhonePoseReading& reading) {
  const double seconds = to_seconds(reading.time);
  Eigen::Vector3d p_PW = p_PW_;
  double yaw_PW = yaw_PW_;
  if (params_.jump && seconds >= params_.jump->at_s) {
    p_PW += params_.jump->translation;
    yaw_PW += params_.jump->yaw;
  }
  const Eigen::Quaterniond q_PW = from_yaw(yaw_PW);

  PhonePose pose;
  pose.session = params_.session;
  pose.sequence = ++sequence_;
  pose.time = from_seconds(params_.clock_offset + (1.0 + params_.clock_drift) * seconds);
  pose.position = p_PW + q_PW * reading.position;
  pose.attitude = (q_PW * reading.attitude).normalized();
  const Eigen::Matrix3d R_PW = q_PW.toRotationMatrix();
  const auto in_phone = [&R_PW](const Eigen::Vector3d& stddev) -> Eigen::Matrix3d {
    // A phone that claims to be perfect is not believed.
    const Eigen::Vector3d variance = stddev.cwiseMax(1e-4).cwiseAbs2();
    const Eigen::Matrix3d turned = R_PW * variance.asDiagonal() * R_PW.transpose();
    return 0.5 * (turned + turned.transpose());
  };
  pose.covariance.emplace(Eigen::Matrix<double, 6, 6>::Zero());
  pose.covariance->topLeftCorner<3, 3>() = in_phone(reading.position_stddev);
  pose.covariance->bottomRightCorner<3, 3>() = in_phone(reading.attitude_stddev);
  return pose;
}

}  // namespace swiftlet
