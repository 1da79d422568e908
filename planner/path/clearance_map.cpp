// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/path/clearance_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace swiftlet {
namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSpare = 5.0;  // of an area that has to grow, all around [m]

template <class Cells>
Eigen::Vector2d upper_corner(const Cells& cells) {
  return cells.origin() + cells.resolution() * Eigen::Vector2d(cells.width(), cells.height());
}

}  // namespace

ClearanceMap::ClearanceMap(const PathCost& cost) : cost_(cost) {}

Status ClearanceMap::check_cost() const {
  if (cost_.radius >= 0.0 && cost_.margin >= 0.0 && std::isfinite(cost_.hard_clearance()) &&
      cost_.clearance_weight >= 0.0 && std::isfinite(cost_.clearance_weight) &&
      cost_.unknown_weight >= 0.0 && std::isfinite(cost_.unknown_weight) &&
      std::isfinite(cost_.preferred_clearance)) {
    return {};
  }
  return Error{"the vehicle's size, clearances or weights are negative or not finite"};
}

Result<ClearanceMap> ClearanceMap::make(const OccupancyGrid& grid, const PathCost& cost,
                                        const std::vector<Eigen::Vector2d>& reach, double border) {
  ClearanceMap map(cost);
  if (Status status = map.update(grid, reach, border); !status) return status.error();
  return map;
}

Status ClearanceMap::update(const OccupancyGrid& grid, const std::vector<Eigen::Vector2d>& reach,
                            double border) {
  if (!empty() && grid.resolution() != resolution()) *this = ClearanceMap(cost_);
  Result<OccupancyGrid> padded = pad(grid, reach, border);
  if (!padded) {
    *this = ClearanceMap(cost_);
    return padded.error();
  }
  if (empty()) {
    // Two cells more than what costs: interpolation, and the neighbours of a ridge.
    known_clearance_ = cost_.free_clearance() + 2.0 * grid.resolution();
    DistanceField::Params params;
    params.unknown_is_obstacle = !cost_.unknown_is_free;
    params.max_distance = known_clearance_ + 0.5 * grid.resolution();
    field_ = DistanceField(params);
  }
  field_.update(*padded);
  open_ = cost_.unknown_is_free && border >= known_clearance_;
  unknown_.resize(field_.values().size());
  density_.resize(field_.values().size());
  std::vector<CellState> states;
  std::size_t i = 0;
  for (int y = 0; y < height(); ++y) {
    padded->states_of_row(y, states);
    for (int x = 0; x < width(); ++x, ++i) {
      const bool unknown = states[static_cast<std::size_t>(x)] == CellState::kUnknown;
      if (unknown == (unknown_[i] != 0)) continue;
      unknown_[i] = unknown;
      set_density({x, y});
    }
  }
  for (const RowSpan& span : field_.changed()) {
    for (int x = span.first; x <= span.last; ++x) set_density({x, span.y});
  }
  return {};
}

/// The grid with a border, and all that belonged to the map before.
Result<OccupancyGrid> ClearanceMap::pad(const OccupancyGrid& grid,
                                        const std::vector<Eigen::Vector2d>& reach,
                                        double border) const {
  if (grid.empty()) return Error{"there is no map to plan in yet"};
  if (Status status = check_cost(); !status) return status.error();
  if (!(border >= 0.0)) return Error{"the border around a map is negative or not finite"};
  OccupancyGrid padded = grid;
  const double half = 0.5 * grid.resolution();
  const auto around = [&](const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, double by) {
    return padded.cover(lower - Eigen::Vector2d::Constant(by),
                        upper + Eigen::Vector2d::Constant(by));
  };
  Status status = around(grid.origin(), upper_corner(grid), border - half);
  for (const Eigen::Vector2d& point : reach) {
    if (status.ok()) status = around(point, point, border);
  }
  if (!status) return status.error();
  // Another grid, far away, need not go together with this one.
  if (empty() || !around(origin(), upper_corner(field_), -half)) return padded;
  const bool grows = padded.width() != width() || padded.height() != height();
  if (grows) (void)around(padded.origin(), upper_corner(padded), kSpare - half);
  return padded;
}

void ClearanceMap::set_density(Cell cell) {
  const double unknown = unknown_[index(cell)] != 0 ? cost_.unknown_weight : 0.0;
  density_[index(cell)] = static_cast<float>(penalty(clearance(cell)) + unknown);
}

double ClearanceMap::penalty(double clearance) const {
  const double hard = cost_.hard_clearance();
  if (!(clearance >= hard)) return kInfinity;
  if (clearance >= cost_.preferred_clearance) return 1.0;
  const double lack = (cost_.preferred_clearance - clearance) / (cost_.preferred_clearance - hard);
  return 1.0 + cost_.clearance_weight * lack * lack;
}

Cell ClearanceMap::cell_of(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d cells = (point - origin()) / resolution();
  // Also false for NaN.
  if (!(cells.x() >= 0 && cells.y() >= 0 && cells.x() < width() && cells.y() < height())) {
    return {-1, -1};
  }
  return {static_cast<int>(cells.x()), static_cast<int>(cells.y())};
}

Eigen::Vector2d ClearanceMap::center_of(Cell cell) const {
  return origin() + resolution() * Eigen::Vector2d(cell.x + 0.5, cell.y + 0.5);
}

double ClearanceMap::clearance_at(const Eigen::Vector2d& point) const {
  if (empty() || !point.allFinite()) return -1.0;
  if (!contains(point)) return open_ ? known_clearance_ : -1.0;
  return field_.distance_at(point) - 0.5 * resolution();
}

bool ClearanceMap::unknown_at(const Eigen::Vector2d& point) const {
  const Cell cell = cell_of(point);
  return !contains(cell) || unknown_[index(cell)] != 0;
}

double ClearanceMap::density_at(const Eigen::Vector2d& point) const {
  const double base = penalty(clearance_at(point));
  return base + (base < kInfinity && unknown_at(point) ? cost_.unknown_weight : 0.0);
}

double ClearanceMap::segment_cost(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
  if (empty() || !a.allFinite() || !b.allFinite()) return kInfinity;
  if (contains(a) && contains(b)) return inner_cost(a, b);
  if (!open_) return kInfinity;
  // The part of the line that is inside (Liang and Barsky), and the rest.
  const Eigen::Vector2d along = b - a, upper = upper_corner(field_);
  double enters = 0.0, leaves = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    double first = (origin()[axis] - a[axis]) / along[axis];
    double last = (upper[axis] - a[axis]) / along[axis];
    if (first > last) std::swap(first, last);
    if (along[axis] == 0.0) {
      const bool beside = a[axis] < origin()[axis] || a[axis] >= upper[axis];
      first = beside ? 2.0 : 0.0;
      last = 1.0;
    }
    enters = std::max(enters, first);
    leaves = std::min(leaves, last);
  }
  const double inside = std::max(0.0, leaves - enters);
  const double outer = (1.0 - inside) * along.norm() * (1.0 + cost_.unknown_weight);
  return inside > 0.0 ? outer + inner_cost(a + enters * along, a + leaves * along) : outer;
}

/// Between two points inside, or on its edge.
double ClearanceMap::inner_cost(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
  const double length = (b - a).norm();
  const int steps = std::max(1, static_cast<int>(std::ceil(length / (0.5 * resolution()))));
  // The same as density_at, without its questions: between two points inside, all are inside.
  const double per_cell = 1.0 / resolution();
  const Eigen::Vector2d first = (a - origin()) * per_cell, step = (b - a) * (per_cell / steps);
  const double hard = cost_.hard_clearance() + 0.5 * resolution();
  const double preferred = cost_.preferred_clearance + 0.5 * resolution();
  const double slope = preferred > hard ? 1.0 / (preferred - hard) : 0.0;
  const double x_max = std::max(0, width() - 2), y_max = std::max(0, height() - 2);
  const float* distance = field_.values().data();
  const std::ptrdiff_t up = height() > 1 ? width() : 0, right = width() > 1 ? 1 : 0;
  double sum = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double x = first.x() + i * step.x(), y = first.y() + i * step.y();
    const double x0 = std::clamp(std::floor(x - 0.5), 0.0, x_max);
    const double y0 = std::clamp(std::floor(y - 0.5), 0.0, y_max);
    const double u = std::clamp(x - 0.5 - x0, 0.0, 1.0), v = std::clamp(y - 0.5 - y0, 0.0, 1.0);
    const float* d =
        distance + static_cast<std::ptrdiff_t>(y0) * width() + static_cast<std::ptrdiff_t>(x0);
    const double low = d[0] + u * static_cast<double>(d[right] - d[0]);
    const double high = d[up] + u * static_cast<double>(d[up + right] - d[up]);
    const double here = low + v * (high - low);
    if (!(here >= hard)) return kInfinity;
    const double lack = here < preferred ? (preferred - here) * slope : 0.0;
    const bool unknown = unknown_[index({std::min(static_cast<int>(x), width() - 1),
                                         std::min(static_cast<int>(y), height() - 1)})] != 0;
    const double density =
        1.0 + cost_.clearance_weight * lack * lack + (unknown ? cost_.unknown_weight : 0.0);
    sum += (i == 0 || i == steps) ? 0.5 * density : density;  // trapezoidal rule
  }
  return sum * length / steps;
}

}  // namespace swiftlet
