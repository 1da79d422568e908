// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/geodesy/local_origin.hpp"

namespace swiftlet {

/// Where a satellite receiver is.
struct GlobalFix {
  GlobalPosition position;
  double sigma = 0.0;  ///< standard deviation on the plane [m]
};

}  // namespace swiftlet
