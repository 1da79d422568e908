// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace swiftlet {

double from_degrees(double degrees);  ///< [rad], counter-clockwise from east both
/// A heading as MAVLink has it, clockwise from north [deg], as a yaw in (-pi, pi] [rad].
double from_compass(double compass_deg);

/// The decimal number with the fewest digits that `from`, one of the above, makes `yaw` [rad] of
/// exactly; where none does, since degrees are the coarser numbers there, one within a rounding.
std::string shortest_degrees(double yaw, double (*from)(double));

}  // namespace swiftlet
