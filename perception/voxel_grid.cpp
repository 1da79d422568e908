// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/voxel_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace swiftlet {
namespace {

constexpr double kTouch = 1e-9;  // nearer is touching [voxels]

/// Of a value from -1 on: std::floor is a call where the processor may be an old one.
int floor_of(double value) {
  return static_cast<int>(value + 1.0) - 1;
}

/// A line that goes up along its main axis m by one for each step; along u and v by less.
struct Line {
  int m, u, v;
  Eigen::Vector3d a, b;
  double slope_u, slope_v;

  Line(const Eigen::Vector3d& from, const Eigen::Vector3d& to) : a(from), b(to) {
    const Eigen::Vector3d length = (b - a).cwiseAbs();
    length.maxCoeff(&m);
    u = (m + 1) % 3;
    v = (m + 2) % 3;
    if (a[m] > b[m]) std::swap(a, b);
    const double along = b[m] - a[m];
    slope_u = along > 0.0 ? (b[u] - a[u]) / along : 0.0;
    slope_v = along > 0.0 ? (b[v] - a[v]) / along : 0.0;
  }
  double u_at(double s) const { return a[u] + (s - a[m]) * slope_u; }
  double v_at(double s) const { return a[v] + (s - a[m]) * slope_v; }
};

class LineCheck {
 public:
  LineCheck(const VoxelGrid& grid, const Line& line) : grid_(grid), line_(line) {}

  /// The part of the line within [k, k + 1] along the main axis, from s0 to s1.
  bool column_is_free(int k, double s0, double s1) const {
    const double u0 = line_.u_at(s0), u1 = line_.u_at(s1), v0 = line_.v_at(s0), v1 = line_.v_at(s1);
    const int low_u = floor_of(std::min(u0, u1) - kTouch),
              high_u = floor_of(std::max(u0, u1) + kTouch),
              low_v = floor_of(std::min(v0, v1) - kTouch),
              high_v = floor_of(std::max(v0, v1) + kTouch);
    // Where it changes along one axis only, it touches all there are.
    if (low_u == high_u || low_v == high_v) return are_free(k, low_u, high_u, low_v, high_v);
    // Where it goes from one cube into the next: slopes are at most 1, so once an axis, or it
    // begins or ends there.
    std::array<double, 6> at{s0, s1};
    std::size_t count = 2;
    const auto add = [&](double s) {  // keeps them in order
      if (!(s > s0 && s < s1) || count == at.size()) return;
      std::size_t i = count++;
      for (; at[i - 1] > s; --i) at[i] = at[i - 1];
      at[i] = s;
    };
    const double a_m = line_.a[line_.m], a_u = line_.a[line_.u], a_v = line_.a[line_.v];
    for (int u = low_u + 1; u <= high_u; ++u) add(a_m + (u - a_u) / line_.slope_u);
    for (int v = low_v + 1; v <= high_v; ++v) add(a_m + (v - a_v) / line_.slope_v);
    for (std::size_t i = 0; i < count; ++i) {
      if (!place_is_free(k, at[i])) return false;
      if (i + 1 < count && !place_is_free(k, 0.5 * (at[i] + at[i + 1]))) return false;
    }
    return true;
  }

 private:
  bool place_is_free(int k, double s) const {
    const double u = line_.u_at(s), v = line_.v_at(s);
    return are_free(k, floor_of(u - kTouch), floor_of(u + kTouch), floor_of(v - kTouch),
                    floor_of(v + kTouch));
  }

  bool are_free(int k, int low_u, int high_u, int low_v, int high_v) const {
    const auto stride_u = grid_.stride(line_.u), stride_v = grid_.stride(line_.v);
    const std::size_t first = static_cast<std::size_t>(
        (k + 1) * grid_.stride(line_.m) + (low_u + 1) * stride_u + (low_v + 1) * stride_v);
    for (int i = 0; i <= high_u - low_u; ++i) {
      for (int j = 0; j <= high_v - low_v; ++j) {
        if (grid_.blocked(first + static_cast<std::size_t>(i * stride_u + j * stride_v))) {
          return false;
        }
      }
    }
    return true;
  }

  const VoxelGrid& grid_;
  const Line& line_;
};

bool is_inside(const VoxelGrid& grid, const Eigen::Vector3d& point) {
  // Also false for what is no number.
  return point.minCoeff() >= 0.0 && point.x() <= grid.size_x() && point.y() <= grid.size_y() &&
         point.z() <= grid.size_z();
}

constexpr std::uint16_t kFar = UINT16_MAX;

/// Adds to squared gaps those along one axis: of each place the least over the places on its line.
std::vector<std::uint16_t> with_gaps_along(const std::vector<std::uint16_t>& squared, int stride,
                                           int count, int reach) {
  std::vector<std::uint16_t> result(squared.size());
  const auto step = static_cast<std::size_t>(stride);
  const auto places = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < squared.size(); ++i) {
    const auto at = static_cast<int>(i / step % places);
    int least = squared[i];
    for (int d = 1; d <= reach; ++d) {
      const int gap = (d - 1) * (d - 1);
      if (gap >= least) break;
      if (at >= d) least = std::min(least, squared[i - step * static_cast<std::size_t>(d)] + gap);
      if (at + d < count) {
        least = std::min(least, squared[i + step * static_cast<std::size_t>(d)] + gap);
      }
    }
    result[i] = static_cast<std::uint16_t>(std::min<int>(least, kFar));
  }
  return result;
}

}  // namespace

Result<VoxelGrid> VoxelGrid::make(int width, int depth, int height) {
  if (width < 1 || depth < 1 || height < 1) {
    return Error{fmt::format("a box of {} x {} x {} voxels has no inside", width, depth, height)};
  }
  const double stored = (width + 2.0) * (depth + 2.0) * (height + 2.0);
  if (stored > static_cast<double>(kMaxVoxels)) {
    return Error{
        fmt::format("{} x {} x {} voxels are more than {}", width, depth, height, kMaxVoxels)};
  }
  VoxelGrid grid;
  grid.size_ = {width, depth, height};
  grid.stride_ = {1, width + 2, (width + 2) * (depth + 2)};
  grid.stored_ = static_cast<std::size_t>(stored);
  grid.words_.assign((grid.stored_ + 63) / 64, ~std::uint64_t{0});
  for (int z = 0; z < height; ++z) {
    for (int y = 0; y < depth; ++y) {
      for (int x = 0; x < width; ++x) grid.set_blocked({x, y, z}, false);
    }
  }
  return grid;
}

Voxel VoxelGrid::voxel_at(std::size_t index) const {
  const auto i = static_cast<int>(index);
  return {i % stride_.y - 1, i % stride_.z / stride_.y - 1, i / stride_.z - 1};
}

VoxelGrid VoxelGrid::grown(double radius) const {
  VoxelGrid result = *this;
  if (!(radius >= 0.0) || empty()) return result;
  constexpr double kMostRadius = 200.0;  // whose square is well below kFar
  const double bounded = std::min(radius, kMostRadius);
  const int reach = floor_of(bounded) + 1;
  std::vector<std::uint16_t> squared(stored_);
  for (std::size_t i = 0; i < stored_; ++i) squared[i] = blocked(i) ? 0 : kFar;
  squared = with_gaps_along(squared, 1, stride_.y, reach);
  squared = with_gaps_along(squared, stride_.y, size_.y + 2, reach);
  squared = with_gaps_along(squared, stride_.z, size_.z + 2, reach);
  for (std::size_t i = 0; i < stored_; ++i) result.set(i, squared[i] <= bounded * bounded);
  return result;
}

bool sees(const VoxelGrid& grid, Voxel from, Voxel to) {
  // Moments of the way are counted such that it leaves voxels at whole ones, along every axis.
  const std::array<int, 3> way{to.x - from.x, to.y - from.y, to.z - from.z};
  std::int64_t product = 1;
  for (const int length : way) product *= std::max(1, std::abs(length));
  std::array<std::int64_t, 3> next{}, period{}, step{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t half = product / std::max(1, std::abs(way[i]));
    next[i] = way[i] == 0 ? std::numeric_limits<std::int64_t>::max() : half;
    period[i] = 2 * half;
    step[i] = way[i] < 0 ? -grid.stride(static_cast<int>(i)) : grid.stride(static_cast<int>(i));
  }
  const auto blocked = [&grid](std::int64_t index) {
    return grid.blocked(static_cast<std::size_t>(index));
  };
  const auto goal = static_cast<std::int64_t>(grid.index(to));
  auto at = static_cast<std::int64_t>(grid.index(from));
  if (blocked(at)) return false;
  while (at != goal) {
    const std::int64_t now = std::min({next[0], next[1], next[2]});
    unsigned leaving = 0;
    std::int64_t after = at;
    for (std::size_t i = 0; i < 3; ++i) {
      if (next[i] != now) continue;
      leaving |= 1U << i;
      next[i] += period[i];
      after += step[i];
    }
    if (blocked(after)) return false;
    if ((leaving & (leaving - 1)) != 0) {
      // Through an edge or a corner: it touches all that meet there.
      for (unsigned some = 1; some < leaving; ++some) {
        if ((some & ~leaving) != 0) continue;
        std::int64_t beside = at;
        for (std::size_t i = 0; i < 3; ++i) beside += (some >> i & 1U) != 0 ? step[i] : 0;
        if (blocked(beside)) return false;
      }
    }
    at = after;
  }
  return true;
}

bool line_is_free(const VoxelGrid& grid, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  if (!is_inside(grid, a) || !is_inside(grid, b)) return false;
  const Line line(a, b);
  const LineCheck check(grid, line);
  const double begin = line.a[line.m], end = line.b[line.m];
  const int last = floor_of(end + kTouch);
  for (int k = floor_of(begin - kTouch); k <= last; ++k) {
    const double s0 = std::clamp<double>(k, begin, end), s1 = std::clamp(k + 1.0, begin, end);
    if (!check.column_is_free(k, s0, s1)) return false;
  }
  return true;
}

}  // namespace swiftlet
