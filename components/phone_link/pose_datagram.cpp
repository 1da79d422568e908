// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/phone_link/pose_datagram.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "components/phone_link/pose_fields.hpp"

namespace swiftlet {
namespace {

constexpr double kFarthest = 1e6;                       // [m]
constexpr double kUnitTolerance = 1e-3;                 // of the length of a quaternion
constexpr Duration kLatest{4'000'000'000'000'000'000};  // the year 2096, since 1970

}  // namespace

Status check_pose(const PhonePose& pose) {
  if (pose.time < Duration(0) || pose.time > kLatest) {
    return Error{"its time is not within 0 and 4e9 s"};
  }
  if (!pose.position.allFinite() || pose.position.cwiseAbs().maxCoeff() > kFarthest) {
    return Error{"its position is not finite, or beyond 1000 km"};
  }
  const double length = pose.attitude.norm();
  if (!(std::abs(length - 1.0) <= kUnitTolerance)) {
    return Error{fmt::format("its quaternion has the length {:.4g}, not 1", length)};
  }
  if (pose.covariance) {
    if (!pose.covariance->allFinite() || *pose.covariance != pose.covariance->transpose() ||
        pose.covariance->llt().info() != Eigen::Success) {
      return Error{"its covariance is not symmetric and positive definite"};
    }
  }
  return {};
}

std::uint32_t crc32_of(const std::uint8_t* bytes, std::size_t size) {
  return static_cast<std::uint32_t>(crc32(0, bytes, static_cast<uInt>(size)));
}

Result<PhonePose> decode_pose(const std::uint8_t* bytes, std::size_t size, JsonPolicy json) {
  if (size > kLongestDatagram) return Error{"it is longer than any pose"};
  // A space or two before the brace do no harm in JSON; no binary datagram begins so.
  std::size_t first = 0;
  while (first < size && (bytes[first] == ' ' || bytes[first] == '\n')) ++first;
  if (first == size || bytes[first] != '{') return decode_binary(bytes, size);
  if (json == JsonPolicy::kRefused) {
    return Error{"it is JSON, which is not taken here; see the parameter 'json'"};
  }
  return decode_json(bytes, size, json == JsonPolicy::kChecked);
}

}  // namespace swiftlet
