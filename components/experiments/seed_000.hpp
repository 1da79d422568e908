// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

/// What seed 000, "Flying Smartphones", measured.
namespace swiftlet::seed_000 {

inline constexpr const char* kAxes[] = {"x", "y", "z"};
inline const Eigen::Vector3d kPhonePosition(0.0165, 0.0320, 0.0274);     ///< Table 2 [m]
inline const Eigen::Vector3d kFilterPosition(0.0195, 0.0296, 0.0299);    ///< Table 2 [m]
inline constexpr double kPhonePsi = 0.0627, kFilterPsi = 0.091;          ///< Table 2
inline const Eigen::Vector3d kFilterVelocity(0.0651, 0.0533, 0.0788);    ///< Table 3 [m/s]
inline const Eigen::Vector3d kPhoneTracking(0.0593, 0.0719, 0.0122);     ///< Table 4 [m]
inline const Eigen::Vector3d kPositionTracking(0.0565, 0.0657, 0.0125);  ///< Table 4 [m]
inline const Eigen::Vector3d kVelocityTracking(0.0626, 0.0833, 0.0214);  ///< Table 5 [m/s]

}  // namespace swiftlet::seed_000
