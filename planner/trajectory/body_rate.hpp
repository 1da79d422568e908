// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/geometry/rigid_body.hpp"
#include "planner/trajectory/piecewise_polynomial.hpp"

namespace swiftlet {

/// Norm of the body's angular velocity [rad/s] of a multirotor that follows a reference without
/// error: roll, pitch and yaw rate of the attitude whose z axis points along the thrust per mass
/// f = a + g e3 and whose y axis is at right angles to the heading h = (cos yaw, sin yaw, 0)
/// (Mellinger and Kumar 2011, section III; control/flatness.hpp has the attitude itself).
///
/// With f and the jerk j written along heading, aside and up, as (c, l, u) and (j_c, j_l, j_u), and
/// m = l^2 + u^2, n = m + c^2 = |f|^2, k = u j_l - l j_u:
///
///     w_x = -k / sqrt(n m)                            roll rate
///     w_y = (j_c m - c (l j_l + u j_u)) / (n sqrt(m))  pitch rate
///     w_z = (yaw_rate u n - k c) / (sqrt(n) m)         yaw rate
///
/// The heading adds yaw_rate u / m sqrt(n) to w_z, which is yaw_rate itself while hovering; the
/// rest of w_z is what keeps a tilted body on its heading. Roll and pitch rate together are
/// |f x j| / |f|^2, whatever the heading. Infinite in free fall (f = 0)
/// and where the thrust points along the heading.
double body_rate(const FlatReference& reference);

/// Upper bound [rad/s] of the body rate on a segment, true at every moment and at most 1e-6
/// (relative) above a rate that is reached, or at most `good_enough`. Infinite where the thrust may
/// vanish or point along the heading.
double max_body_rate(const TrajectorySegment& segment, double good_enough = 0.0);

}  // namespace swiftlet
