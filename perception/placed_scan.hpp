// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimation/basics/time.hpp"
#include "estimation/geometry/pose_history.hpp"
#include "perception/laser_scan.hpp"

namespace swiftlet {

/// When the last beam of a scan was measured whose first was at `begin`. Times between beams that
/// no scanner has (not finite, backwards, a turn of more than a second) count as none.
Time end_of(const LaserScan& scan, Time begin);

/// The returns of a scan where they are in the world [m], in the order of the beams: each from
/// where the scanner was when that beam was measured. `body` are poses of what carries the scanner,
/// which sits `mount` on it. A beam for whose time there is no pose, also not between two that are
/// `max_gap` apart or less, is left out.
std::vector<Eigen::Vector3d> placed_returns(const LaserScan& scan, Time begin,
                                            const PoseHistory& body, const PoseHistory::Pose& mount,
                                            Duration max_gap);

}  // namespace swiftlet
