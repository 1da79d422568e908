// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "components/sim/quadrotor.hpp"

namespace swiftlet {

enum class MadeUpMotion {
  kHover,   ///< 1 m above the start
  kCircle,  ///< a level circle of 1 m radius through there, at 0.5 m/s, heading along it
};

/// The vehicle at `time` after the start, for who has none to follow.
VehicleTruth made_up_truth(MadeUpMotion motion, Time time);

}  // namespace swiftlet
