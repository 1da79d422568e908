// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "components/bag/carmen/carmen_log.hpp"
#include "components/experiments/slam/relations.hpp"

namespace swiftlet {

/// The odometry of a log, that at its scans included, in the order of time.
///
/// A logger that was busy stamps all that waited for it in one go, and one that keeps its lines in
/// the order of time gives a line whose stamp would be before that of the last the time of that and
/// a millisecond more: such stamps tell the order, not the time. Odometry comes at a steady rate,
/// so lines that come within a tick of the one before get the time that the stamps of those around
/// say (a straight line through thirty of them), but none that is later than what stands there. A
/// line from which no vehicle could have come to the next in time was stamped too late.
std::vector<TimedPose2> timed_odometry(const carmen::Log& log);

}  // namespace swiftlet
