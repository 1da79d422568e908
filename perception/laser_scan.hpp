// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace swiftlet {

/// One turn of a planar laser scanner. Beam i points at `angle_min + i * angle_increment` in the
/// x-y plane of the scanner's frame L, counted from x towards y.
///
/// A range from `range_min` to below `range_max` is a return. Everything else follows REP-117:
/// +infinity and ranges from `range_max` up saw nothing within `range_max`; NaN, -infinity and
/// ranges below `range_min` are beams of which nothing is known.
struct LaserScan {
  double angle_min = 0.0;        ///< of the first beam [rad]
  double angle_increment = 0.0;  ///< from one beam to the next, of either sign [rad]
  double time_increment = 0.0;   ///< from one beam to the next [s]
  double range_min = 0.0;        ///< [m]
  double range_max = 0.0;        ///< [m]
  std::vector<float> ranges;     ///< one a beam [m]
};

}  // namespace swiftlet
