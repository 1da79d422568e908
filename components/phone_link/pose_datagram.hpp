// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "estimation/basics/result.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

/// One pose as a phone sends it: of its camera C in its own frame P, by its own clock.
struct PhonePose {
  std::uint32_t session = 0;   ///< chosen at random when the sender started
  std::uint32_t sequence = 0;  ///< one more for each pose
  Duration time{};             ///< since whenever the phone's clock began; not negative
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< p_PC [m]
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< q_PC
  /// Position [m^2], then rotation about the axes of P [rad^2], as geometry_msgs has it. Positive
  /// definite.
  std::optional<Eigen::Matrix<double, 6, 6>> covariance;
};

using DatagramBytes = std::vector<std::uint8_t>;

/// The longest that can be a pose; what is longer is none.
inline constexpr std::size_t kLongestDatagram = 2048;

/// What is taken in JSON.
enum class JsonPolicy {
  kRefused,
  kChecked,  ///< only with "crc32": a changed digit would be another pose
  kAny,
};

/// The binary form, see the byte table in README.md. The covariance loses all but the digits of a
/// float.
DatagramBytes encode_binary(const PhonePose& pose);
/// The same as JSON, with "crc32" at the end.
DatagramBytes encode_json(const PhonePose& pose);

/// Reads either form. The reason says what is wrong with the bytes, for who writes a sender.
Result<PhonePose> decode_pose(const std::uint8_t* bytes, std::size_t size, JsonPolicy json);

}  // namespace swiftlet
