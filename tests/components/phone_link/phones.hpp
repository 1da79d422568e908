// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Poses for tests of the phone link.
#pragma once

#include <random>
#include <string>

#include "components/phone_link/pose_datagram.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet::test {

/// A pose with random numbers in all fields.
inline PhonePose random_pose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const auto vector = [&] {
    return Eigen::Vector3d(normal(random), normal(random), normal(random));
  };
  PhonePose pose;
  pose.session = static_cast<std::uint32_t>(random());
  pose.sequence = static_cast<std::uint32_t>(random());
  pose.time = Duration(static_cast<std::int64_t>(random()) * 1'000'003);
  pose.position = 10.0 * vector();
  pose.attitude = exp_so3(vector());
  if (random() % 2 == 0) {
    Eigen::Matrix<float, 6, 6> root;  // floats, which the binary form keeps
    for (float& number : root.reshaped()) number = static_cast<float>(normal(random));
    const Eigen::Matrix<float, 6, 6> product =
        root * root.transpose() + Eigen::Matrix<float, 6, 6>::Identity();
    pose.covariance = (0.5F * (product + product.transpose())).template cast<double>();
  }
  return pose;
}

inline DatagramBytes bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}
inline std::string text_of(const DatagramBytes& bytes) {
  return {bytes.begin(), bytes.end()};
}
inline Result<PhonePose> decode(const DatagramBytes& bytes, JsonPolicy json = JsonPolicy::kAny) {
  return decode_pose(bytes.data(), bytes.size(), json);
}

}  // namespace swiftlet::test
