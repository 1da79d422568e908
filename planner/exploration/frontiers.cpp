// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/exploration/frontiers.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace swiftlet {
namespace {

/// The unseen cells that matter, in pieces that hang together.
class UnseenPieces {
 public:
  UnseenPieces(const SeenSpace& space, const std::vector<std::uint8_t>& matters)
      : width_(space.width()), height_(space.height()), piece_(matters.size(), kNone) {
    std::vector<Cell> cells;
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        const auto take = [&](Cell cell) {
          if (!contains(cell) || piece_[index(cell)] != kNone || matters[index(cell)] == 0 ||
              !space.is_unseen(cell)) {
            return false;
          }
          piece_[index(cell)] = static_cast<std::int32_t>(sizes_.size());
          return true;
        };
        if (!take({x, y})) continue;
        cells.assign(1, {x, y});
        for (std::size_t i = 0; i < cells.size(); ++i) {
          for (const Cell step : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
            const Cell next{cells[i].x + step.x, cells[i].y + step.y};
            if (take(next)) cells.push_back(next);
          }
        }
        sizes_.push_back(cells.size());
      }
    }
  }

  bool contains(Cell cell) const {
    return cell.x >= 0 && cell.y >= 0 && cell.x < width_ && cell.y < height_;
  }
  bool has(Cell cell) const { return contains(cell) && piece_[index(cell)] != kNone; }
  /// Of the piece with the cell, in cells.
  std::size_t size(Cell cell) const {
    return sizes_[static_cast<std::size_t>(piece_[index(cell)])];
  }

 private:
  static constexpr std::int32_t kNone = -1;
  std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(cell.x);
  }
  int width_, height_;
  std::vector<std::int32_t> piece_;
  std::vector<std::size_t> sizes_;
};

bool is_beside_open(const SeenSpace& space, Cell cell) {
  const auto open = [&space](int x, int y) {
    return space.contains({x, y}) && space.is_open({x, y});
  };
  return open(cell.x - 1, cell.y) || open(cell.x + 1, cell.y) || open(cell.x, cell.y - 1) ||
         open(cell.x, cell.y + 1);
}

Frontier make_frontier(std::vector<Cell> cells) {
  double x = 0.0, y = 0.0;
  for (const Cell cell : cells) {
    x += cell.x;
    y += cell.y;
  }
  x /= static_cast<double>(cells.size());
  y /= static_cast<double>(cells.size());
  const auto off = [x, y](Cell cell) {
    return (cell.x - x) * (cell.x - x) + (cell.y - y) * (cell.y - y);
  };
  const auto nearest = std::min_element(cells.begin(), cells.end(),
                                        [&off](Cell a, Cell b) { return off(a) < off(b); });
  const Cell middle = *nearest;
  return {std::move(cells), middle, 0.0};
}

void cut(std::vector<Cell> cells, int most, std::vector<Frontier>& frontiers) {
  const auto by_x = [](Cell a, Cell b) { return a.x != b.x ? a.x < b.x : a.y < b.y; };
  const auto by_y = [](Cell a, Cell b) { return a.y != b.y ? a.y < b.y : a.x < b.x; };
  const auto x = std::minmax_element(cells.begin(), cells.end(), by_x);
  const auto y = std::minmax_element(cells.begin(), cells.end(), by_y);
  const int width = x.second->x - x.first->x, height = y.second->y - y.first->y;
  if (std::max(width, height) <= most) {
    frontiers.push_back(make_frontier(std::move(cells)));
    return;
  }
  const auto half = cells.begin() + static_cast<std::ptrdiff_t>(cells.size() / 2);
  if (width >= height) {
    std::nth_element(cells.begin(), half, cells.end(), by_x);
  } else {
    std::nth_element(cells.begin(), half, cells.end(), by_y);
  }
  cut({cells.begin(), half}, most, frontiers);
  cut({half, cells.end()}, most, frontiers);
}

}  // namespace

std::vector<Frontier> find_frontiers(const SeenSpace& space,
                                     const std::vector<std::uint8_t>& matters, double extent) {
  std::vector<Frontier> frontiers;
  const UnseenPieces unseen(space, matters);
  std::vector<std::uint8_t> taken(matters.size(), 0);
  const auto take = [&](Cell cell) {
    if (!unseen.has(cell) || !is_beside_open(space, cell)) return false;
    const auto index = static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(space.width()) +
                       static_cast<std::size_t>(cell.x);
    return std::exchange(taken[index], std::uint8_t{1}) == 0;
  };
  const int most = std::max(1, static_cast<int>(extent / space.resolution()));
  std::vector<Cell> cells;
  for (int y = 0; y < space.height(); ++y) {
    for (int x = 0; x < space.width(); ++x) {
      if (!take({x, y})) continue;
      cells.assign(1, {x, y});
      for (std::size_t i = 0; i < cells.size(); ++i) {
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            const Cell next{cells[i].x + dx, cells[i].y + dy};
            if (take(next)) cells.push_back(next);
          }
        }
      }
      cut(cells, most, frontiers);
    }
  }
  for (Frontier& frontier : frontiers) {
    std::size_t size = 0;
    for (const Cell cell : frontier.cells) size = std::max(size, unseen.size(cell));
    frontier.area = static_cast<double>(size) * space.resolution() * space.resolution();
  }
  return frontiers;
}

}  // namespace swiftlet
