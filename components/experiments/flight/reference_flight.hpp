// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "components/runtime/config/config.hpp"
#include "estimation/basics/result.hpp"
#include "estimation/geometry/rigid_body.hpp"

namespace swiftlet {

/// A flight in simulation along a given reference: sim, estimator and flight_controller as they fly
/// everywhere, in lockstep on DDS, and in place of the commander a component that says what to do.
struct ReferenceFlight {
  std::filesystem::path scenario;  ///< file, see Scenario; its mission is not flown
  std::uint64_t seed = 1;
  Config parameters;  ///< sections `estimator` and `flight_controller`
  /// What to do so many seconds after the take-off begins, which is on the ground at rest.
  std::function<FlatReference(double seconds)> reference;
  double duration_s = 0.0;
};

/// One moment of a flight, all at the same time.
struct FlightMoment {
  double t = 0.0;  ///< since the take-off began [s]
  RigidBodyState truth;
  RigidBodyState estimate;
  /// As the estimator publishes them: position and attitude, world axes; velocity, body axes.
  Eigen::Matrix<double, 6, 6> pose_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix3d velocity_covariance_B = Eigen::Matrix3d::Zero();
  FlatReference desired;
};

/// One pose of the phone beside the truth at its time.
struct PhoneMoment {
  double t = 0.0;  ///< since the take-off began [s]
  RigidBodyState truth;
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
};

struct FlightSeries {
  std::vector<FlightMoment> moments;  ///< at 100 Hz
  std::vector<PhoneMoment> phone;     ///< as it comes
};

/// Flies. Fails with the reason where the vehicle touches something or falls silent.
Result<FlightSeries> fly(const ReferenceFlight& flight);

}  // namespace swiftlet
