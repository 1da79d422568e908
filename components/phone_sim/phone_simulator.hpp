// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "components/phone_link/pose_datagram.hpp"
#include "components/sim/sensors/phone_pose.hpp"

namespace swiftlet {

/// What a phone on the vehicle would send: poses with the errors of PhonePoseSensor, in a frame and
/// by a clock of its own.
class PhoneSimulator {
 public:
  /// Of the phone's frame against where it was: it finds itself anew.
  struct Jump {
    double at_s = 0.0;                           ///< after the start
    Eigen::Vector3d translation{1.0, 0.0, 0.0};  ///< [m]
    double yaw = 0.0;                            ///< [rad]
  };
  struct Params {
    PhonePoseSensor::Params sensor;  ///< its mount is that of the camera
    double clock_offset = 0.0;       ///< what the phone's clock shows at the start [s]
    double clock_drift = 0.0;        ///< it is faster than ours by that [1]
    bool json = false;
    std::optional<Jump> jump;
    std::uint32_t session = 0;
  };

  /// `seed` decides the errors, and where the phone's frame is.
  PhoneSimulator(const Params& params, std::uint64_t seed);

  /// The datagram that leaves at the time of `truth`, which counts from the start; nothing where
  /// none is due.
  std::optional<DatagramBytes> update(const VehicleTruth& truth);

 private:
  PhonePose pose_of(const PhonePoseReading& reading);

  Params params_;
  PhonePoseSensor sensor_;
  // The map in the phone's frame: only place and heading, since a phone sees gravity.
  Eigen::Vector3d p_PW_;
  double yaw_PW_;
  std::uint32_t sequence_ = 0;
};

}  // namespace swiftlet
