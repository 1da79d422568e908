// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace swiftlet {

struct EnvelopePoint {
  double x = 0.0;
  double y = 0.0;
};

/// y = intercept + slope x.
struct EnvelopeLine {
  double intercept = 0.0;
  double slope = 0.0;
  double at(double x) const { return intercept + slope * x; }
};

/// Of the lines that no point lies below, with a slope within +-`max_slope`, the one that is
/// highest at `x`. `points` are in the order of x, no two at the same, and at least one.
///
/// With the mean of the points' x it is the linear programme of Moon, Skelly and Towsley
/// ("Estimation and removal of clock skew from network delay measurements", INFOCOM 1999), whose
/// solution is an edge of the lower convex hull (Zhang, Liu and Xia, INFOCOM 2002).
EnvelopeLine lower_envelope(const std::vector<EnvelopePoint>& points, double max_slope, double x);

}  // namespace swiftlet
