// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "components/bag/carmen/carmen_log.hpp"
#include "components/experiments/relations.hpp"

namespace swiftlet {

/// The odometry of a log, that at its scans included, in the order of time.
///
/// A logger that keeps its lines in the order of time gives one whose stamp would be before that of
/// the last line the time of that line and a millisecond more: such a stamp tells the order, not
/// the time. Odometry comes at a steady rate, so its lines get the time that the stamps of those
/// around say (a straight line through thirty of them), but none that is later than what stands
/// there.
std::vector<TimedPose2> timed_odometry(const carmen::Log& log);

}  // namespace swiftlet
