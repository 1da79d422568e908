// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "gcs/screen/drawing/surface.hpp"

namespace swiftlet::screen {

/// Half of the horizon's height is so far up from the vehicle's nose [rad].
inline constexpr double kHorizonView = 0.44;  // 25 deg

/// An artificial horizon, as seen from the vehicle: what is ground is hatched. `q_WB` is the
/// attitude, body (FLU) to world (ENU). Nothing but the mark where it is no rotation.
void draw_horizon(const Pane& pane, const Eigen::Quaterniond& q_WB, Style line = {Hue::kCyan});

}  // namespace swiftlet::screen
