// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/clock/lower_envelope.hpp"

#include <algorithm>
#include <cassert>

namespace swiftlet {
namespace {

/// Whether `b` lies on or above the straight line from `a` to `c`.
bool is_covered(const EnvelopePoint& a, const EnvelopePoint& b, const EnvelopePoint& c) {
  return (b.y - a.y) * (c.x - a.x) >= (c.y - a.y) * (b.x - a.x);
}

std::vector<EnvelopePoint> lower_hull(const std::vector<EnvelopePoint>& points) {
  std::vector<EnvelopePoint> hull;
  for (const EnvelopePoint& point : points) {
    while (hull.size() >= 2 && is_covered(hull[hull.size() - 2], hull.back(), point)) {
      hull.pop_back();
    }
    hull.push_back(point);
  }
  return hull;
}

}  // namespace

EnvelopeLine lower_envelope(const std::vector<EnvelopePoint>& points, double max_slope, double x) {
  assert(!points.empty());
  const std::vector<EnvelopePoint> hull = lower_hull(points);
  EnvelopeLine line;
  if (hull.size() > 1) {
    std::size_t end = 1;
    while (end + 1 < hull.size() && hull[end].x < x) ++end;
    const EnvelopePoint& a = hull[end - 1];
    const EnvelopePoint& b = hull[end];
    line.slope = std::clamp((b.y - a.y) / (b.x - a.x), -max_slope, max_slope);
  }
  // As high as the points let a line of that slope be; they touch it at a corner of the hull.
  line.intercept = hull.front().y - line.slope * hull.front().x;
  for (const EnvelopePoint& corner : hull) {
    line.intercept = std::min(line.intercept, corner.y - line.slope * corner.x);
  }
  return line;
}

}  // namespace swiftlet
