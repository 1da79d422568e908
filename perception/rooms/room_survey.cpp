// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/rooms/room_survey.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <optional>
#include <queue>
#include <set>

#include "perception/distance_field.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector2d;

constexpr int kNone = -1;
constexpr std::array<Cell, 4> kSides{Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}};
// Of surface points looked at beside the edge of a free cell [cells].
constexpr double kBeside = 1.5, kInside = -1.5, kBehind = 2.5;
constexpr double kLeastFacing = 0.3;  // cosine between edge and surface
// Of walls, for length and width.
constexpr double kAlongAxis = 0.97;  // cosine
constexpr double kBin = 0.05;        // [m]
constexpr double kWallShare = 0.3;   // points of a wall, of the longest facing that way

/// Which room each cell belongs to, and how far it is from what is not free.
class Partition {
 public:
  Partition(const OccupancyGrid& grid, const RoomSurveyParams& params)
      : grid_(grid), field_(grid, {true, 1e3}), room_of_(cells(), kNone) {
    find_cores(0.5 * params.widest_door, params.least_core);
    grow();
  }

  int rooms() const { return static_cast<int>(centers_.size()); }
  Cell center(int room) const { return centers_[static_cast<std::size_t>(room)]; }
  int room_of(Cell cell) const { return field_.contains(cell) ? room_of_[index(cell)] : kNone; }
  bool is_free(Cell cell) const {
    return field_.contains(cell) && grid_.state(cell) == CellState::kFree;
  }

 private:
  std::size_t cells() const {
    return static_cast<std::size_t>(field_.width()) * static_cast<std::size_t>(field_.height());
  }
  std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(field_.width()) +
           static_cast<std::size_t>(cell.x);
  }
  Cell cell(std::size_t i) const {
    const auto width = static_cast<std::size_t>(field_.width());
    return {static_cast<int>(i % width), static_cast<int>(i / width)};
  }

  /// Connected places that are farther than `reach` from all that is not free.
  void find_cores(double reach, double least_area) {
    const auto is_core = [&](Cell c) { return field_.contains(c) && field_.distance(c) > reach; };
    std::vector<bool> seen(cells(), false);
    for (std::size_t i = 0; i < cells(); ++i) {
      if (seen[i] || !is_core(cell(i))) continue;
      std::vector<Cell> core{cell(i)};
      seen[i] = true;
      for (std::size_t k = 0; k < core.size(); ++k) {
        for (const Cell side : kSides) {
          const Cell next{core[k].x + side.x, core[k].y + side.y};
          if (!is_core(next) || seen[index(next)]) continue;
          seen[index(next)] = true;
          core.push_back(next);
        }
      }
      const double area = static_cast<double>(core.size()) * square(grid_.resolution());
      if (area < least_area) continue;
      for (const Cell c : core) room_of_[index(c)] = rooms();
      centers_.push_back(*std::max_element(core.begin(), core.end(), [&](Cell a, Cell b) {
        return field_.distance(a) < field_.distance(b);
      }));
    }
  }

  /// The widest places first: rooms meet where the way between them is narrowest.
  void grow() {
    struct Front {
      double distance;
      std::size_t cell;
      bool operator<(const Front& other) const {
        return distance < other.distance || (distance == other.distance && cell > other.cell);
      }
    };
    std::priority_queue<Front> open;
    for (std::size_t i = 0; i < cells(); ++i) {
      if (room_of_[i] != kNone) open.push({field_.distance(cell(i)), i});
    }
    while (!open.empty()) {
      const Cell at = cell(open.top().cell);
      open.pop();
      for (const Cell side : kSides) {
        const Cell next{at.x + side.x, at.y + side.y};
        if (!is_free(next) || room_of_[index(next)] != kNone) continue;
        room_of_[index(next)] = room_of_[index(at)];
        open.push({field_.distance(next), index(next)});
      }
    }
  }

  static double square(double value) { return value * value; }

  const OccupancyGrid& grid_;
  DistanceField field_;
  std::vector<int> room_of_;
  std::vector<Cell> centers_;
};

/// Surface points by the cell that they are in.
class PointsByCell {
 public:
  PointsByCell(const OccupancyGrid& grid, const ScanPoints& points) : grid_(grid), points_(points) {
    by_cell_.resize(static_cast<std::size_t>(grid.width()) *
                    static_cast<std::size_t>(grid.height()));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector2d p = (points[i].position - grid.origin()) / grid.resolution();
      if (!points[i].has_normal() || !(p.minCoeff() >= 0.0) || p.x() >= grid.width() ||
          p.y() >= grid.height()) {
        continue;
      }
      by_cell_[static_cast<std::size_t>(p.y()) * static_cast<std::size_t>(grid.width()) +
               static_cast<std::size_t>(p.x())]
          .push_back(static_cast<std::uint32_t>(i));
    }
  }
  template <class Visit>
  void around(Cell cell, int reach, Visit visit) const {
    for (int y = std::max(0, cell.y - reach); y <= std::min(grid_.height() - 1, cell.y + reach);
         ++y) {
      for (int x = std::max(0, cell.x - reach); x <= std::min(grid_.width() - 1, cell.x + reach);
           ++x) {
        const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(grid_.width()) +
                       static_cast<std::size_t>(x);
        for (const std::uint32_t point : by_cell_[i]) visit(point, points_[point]);
      }
    }
  }

 private:
  const OccupancyGrid& grid_;
  const ScanPoints& points_;
  std::vector<std::vector<std::uint32_t>> by_cell_;
};

/// How much larger a room is than its cells, beside one edge of one of them: the surfaces that the
/// edge faces, as far as they face it. A slanted surface is faced by edges of both axes, in shares
/// of sine and cosine squared.
double area_beside(const OccupancyGrid& grid, const PointsByCell& points, Cell cell, Cell side,
                   std::set<std::uint32_t>& used) {
  const Vector2d outward(side.x, side.y), along(-side.y, side.x);
  const double edge = grid.resolution();
  const Vector2d middle =
      grid.origin() + edge * (Vector2d(cell.x + 0.5, cell.y + 0.5) + 0.5 * outward);
  double weights = 0.0, offsets = 0.0, shares = 0.0;
  points.around(cell, 3, [&](std::uint32_t which, const SurfacePoint& point) {
    const Vector2d off = point.position - middle;
    const double facing = -point.normal.dot(outward), out = off.dot(outward) / edge;
    if (facing < kLeastFacing || std::abs(off.dot(along)) > kBeside * edge || out < kInside ||
        out > kBehind) {
      return;
    }
    // Where the line through the point passes the middle of the edge.
    const double offset = off.dot(outward) - off.dot(along) * point.normal.dot(along) / facing;
    const double weight = facing * facing;
    weights += weight;
    offsets += weight * offset;
    shares += weight * weight;
    used.insert(which);
  });
  if (weights == 0.0) return 0.0;
  return edge * (offsets / weights) * (shares / weights);
}

/// The direction of most surfaces, which are at right angles to each other.
double axis_of(const ScanPoints& surfaces, const std::set<std::uint32_t>& used) {
  std::complex<double> sum = 0.0;
  for (const std::uint32_t i : used) {
    const Vector2d& normal = surfaces[i].normal;
    sum += std::pow(std::complex<double>(normal.x(), normal.y()), 4);
  }
  return used.empty() ? 0.0 : 0.25 * std::arg(sum);
}

/// How far the outermost wall is that faces against `direction`; nothing where none does.
std::optional<double> wall_towards(const Vector2d& direction, const ScanPoints& surfaces,
                                   const std::set<std::uint32_t>& used) {
  std::vector<double> places;
  for (const std::uint32_t i : used) {
    if (-surfaces[i].normal.dot(direction) > kAlongAxis) {
      places.push_back(surfaces[i].position.dot(direction));
    }
  }
  if (places.empty()) return std::nullopt;
  std::sort(places.begin(), places.end());
  const auto count_around = [&](double place) {
    return std::upper_bound(places.begin(), places.end(), place + kBin) -
           std::lower_bound(places.begin(), places.end(), place - kBin);
  };
  std::ptrdiff_t most = 0;
  for (const double place : places) most = std::max(most, count_around(place));
  for (auto place = places.rbegin(); place != places.rend(); ++place) {
    if (static_cast<double>(count_around(*place)) < kWallShare * static_cast<double>(most))
      continue;
    const auto first = std::lower_bound(places.begin(), places.end(), *place - 2.0 * kBin);
    const auto last = std::upper_bound(places.begin(), places.end(), *place + kBin);
    return *(first + (last - first) / 2);  // the median
  }
  return std::nullopt;
}

}  // namespace

std::vector<Room> survey_rooms(const OccupancyGrid& grid, const ScanPoints& surfaces,
                               const RoomSurveyParams& params) {
  std::vector<Room> rooms;
  if (grid.empty()) return rooms;
  const Partition partition(grid, params);
  const PointsByCell points(grid, surfaces);
  const double resolution = grid.resolution();
  rooms.resize(static_cast<std::size_t>(partition.rooms()));
  std::vector<std::set<std::uint32_t>> used(rooms.size());
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      const int which = partition.room_of({x, y});
      if (which == kNone) continue;
      const auto room = static_cast<std::size_t>(which);
      rooms[room].area += resolution * resolution;
      for (const Cell side : kSides) {
        if (partition.is_free({x + side.x, y + side.y})) continue;
        rooms[room].area += area_beside(grid, points, {x, y}, side, used[room]);
      }
    }
  }
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    Room& room = rooms[i];
    const Cell center = partition.center(static_cast<int>(i));
    room.center = grid.origin() + resolution * Vector2d(center.x + 0.5, center.y + 0.5);
    room.axis = axis_of(surfaces, used[i]);
    const Vector2d axis(std::cos(room.axis), std::sin(room.axis)), across(-axis.y(), axis.x());
    const auto extent = [&](const Vector2d& direction) {
      const auto ahead = wall_towards(direction, surfaces, used[i]),
                 behind = wall_towards(-direction, surfaces, used[i]);
      return ahead && behind ? *ahead + *behind : 0.0;
    };
    room.length = extent(axis);
    room.width = extent(across);
  }
  std::sort(rooms.begin(), rooms.end(),
            [](const Room& a, const Room& b) { return a.area > b.area; });
  return rooms;
}

}  // namespace swiftlet
