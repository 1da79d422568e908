// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/distance_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <tuple>

namespace swiftlet {
namespace {

/// The lower envelope of parabolas (q - i)^2 + height, in whole numbers, therefore exact.
class LowerEnvelope {
 public:
  static constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();

  void clear() {
    parabolas_.clear();
    next_ = 0;
  }

  /// Of rising `i`.
  void add(int i, std::int64_t height) {
    const double value = static_cast<double>(height + std::int64_t{i} * i);
    double from = -std::numeric_limits<double>::infinity();
    while (!parabolas_.empty()) {
      const Parabola& last = parabolas_.back();
      from = (value - last.value) / (2.0 * (i - last.root));
      if (from > last.from) break;
      parabolas_.pop_back();
      from = -std::numeric_limits<double>::infinity();
    }
    parabolas_.push_back({i, height, value, from});
  }

  /// kNone of no parabolas. `q` must not fall from call to call.
  std::int64_t at(int q) {
    if (parabolas_.empty()) return kNone;
    while (next_ + 1 < parabolas_.size() && parabolas_[next_ + 1].from < q) ++next_;
    const Parabola& lowest = parabolas_[next_];
    const std::int64_t offset = q - lowest.root;
    return offset * offset + lowest.height;
  }

 private:
  struct Parabola {
    int root;
    std::int64_t height;
    double value;  // at zero
    double from;   // it is the lowest from here to the beginning of the next
  };
  std::vector<Parabola> parabolas_;
  std::size_t next_ = 0;
};

}  // namespace

/// Cells of one column, from the first to the last that changed.
struct DistanceField::ColumnSpan {
  int x, first, last;
};

DistanceField::DistanceField() = default;

DistanceField::DistanceField(const Params& params) : params_(params) {}

DistanceField::DistanceField(const OccupancyGrid& grid, const Params& params) : params_(params) {
  update(grid);
}

void DistanceField::update(const OccupancyGrid& grid) {
  const bool same_geometry = width_ == grid.width() && height_ == grid.height() &&
                             resolution_ == grid.resolution() && origin_ == grid.origin();
  if (!same_geometry) start_over(grid);
  std::vector<RowSpan> spans = update_columns(take_obstacles(grid));
  update_rows(spans);
  changed_ = std::move(spans);
  if (same_geometry) return;
  changed_.clear();
  for (int y = 0; y < height_; ++y) changed_.push_back({y, 0, width_ - 1});
}

bool DistanceField::is_obstacle(CellState state) const {
  return state == CellState::kOccupied ||
         (state == CellState::kUnknown && params_.unknown_is_obstacle);
}

/// The field of a grid without obstacles.
void DistanceField::start_over(const OccupancyGrid& grid) {
  origin_ = grid.origin();
  resolution_ = grid.resolution();
  width_ = grid.width();
  height_ = grid.height();
  const std::size_t cells = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  states_.assign(cells, CellState::kFree);
  vertical_.assign(cells, reach() + 1);
  distance_.assign(cells, static_cast<float>(params_.max_distance));
}

/// No obstacle counts that is more columns or rows away.
int DistanceField::reach() const {
  const double cells = std::ceil(params_.max_distance / resolution_);
  return static_cast<int>(std::clamp(cells, 0.0, static_cast<double>(width_ + height_)));
}

/// Where in which column obstacles came or went, column by column.
std::vector<DistanceField::ColumnSpan> DistanceField::take_obstacles(const OccupancyGrid& grid) {
  const auto w = static_cast<std::size_t>(width_);
  std::vector<ColumnSpan> columns(w, ColumnSpan{0, height_, -1});
  std::vector<CellState> states;
  for (int y = 0; y < height_; ++y) {
    grid.states_of_row(y, states);
    CellState* before = states_.data() + static_cast<std::size_t>(y) * w;
    if (std::memcmp(states.data(), before, w) == 0) continue;
    for (int x = 0; x < width_; ++x) {
      const CellState now = states[static_cast<std::size_t>(x)];
      if (is_obstacle(now) == is_obstacle(before[x])) continue;
      ColumnSpan& column = columns[static_cast<std::size_t>(x)];
      column = {x, std::min(column.first, y), y};
    }
    std::copy(states.begin(), states.end(), before);
  }
  const auto is_unchanged = [](const ColumnSpan& column) { return column.last < 0; };
  columns.erase(std::remove_if(columns.begin(), columns.end(), is_unchanged), columns.end());
  return columns;
}

/// First pass: cells to the nearest obstacle above or below. Returns the cells of the field that
/// this can have changed.
std::vector<RowSpan> DistanceField::update_columns(const std::vector<ColumnSpan>& columns) {
  const int far = reach() + 1;
  const auto w = static_cast<std::size_t>(width_);
  std::vector<RowSpan> spans;
  std::vector<int> last_of_row(static_cast<std::size_t>(height_), -1);  // in `spans`
  std::vector<std::int32_t> fresh;
  for (const ColumnSpan& column : columns) {
    const int first = std::max(0, column.first - far),
              last = std::min(height_ - 1, column.last + far);
    const int lowest = std::max(0, first - far), highest = std::min(height_ - 1, last + far);
    const auto at = [&](int y) {
      return static_cast<std::size_t>(y) * w + static_cast<std::size_t>(column.x);
    };
    fresh.assign(static_cast<std::size_t>(last - first + 1), far);
    int cells = far;
    for (int y = lowest; y <= last; ++y) {
      cells = is_obstacle(states_[at(y)]) ? 0 : std::min(cells + 1, far);
      if (y >= first) fresh[static_cast<std::size_t>(y - first)] = cells;
    }
    cells = far;
    for (int y = highest; y >= first; --y) {
      cells = is_obstacle(states_[at(y)]) ? 0 : std::min(cells + 1, far);
      if (y > last) continue;
      const std::int32_t nearest = std::min(cells, fresh[static_cast<std::size_t>(y - first)]);
      if (vertical_[at(y)] == nearest) continue;
      vertical_[at(y)] = nearest;
      const int from = std::max(0, column.x - far), to = std::min(width_ - 1, column.x + far);
      int& latest = last_of_row[static_cast<std::size_t>(y)];
      if (latest >= 0 && spans[static_cast<std::size_t>(latest)].last + 1 >= from) {
        spans[static_cast<std::size_t>(latest)].last = to;
      } else {
        latest = static_cast<int>(spans.size());
        spans.push_back({y, from, to});
      }
    }
  }
  std::sort(spans.begin(), spans.end(), [](const RowSpan& a, const RowSpan& b) {
    return std::tie(a.y, a.first) < std::tie(b.y, b.first);
  });
  return spans;
}

/// Second pass, along the rows.
void DistanceField::update_rows(const std::vector<RowSpan>& spans) {
  const int far = reach() + 1;
  LowerEnvelope envelope;
  for (const RowSpan& span : spans) {
    const std::size_t row = static_cast<std::size_t>(span.y) * static_cast<std::size_t>(width_);
    const std::int32_t* vertical = vertical_.data() + row;
    const int from = std::max(0, span.first - far), to = std::min(width_ - 1, span.last + far);
    envelope.clear();
    for (int x = from; x <= to; ++x) {
      if (vertical[x] < far) envelope.add(x, std::int64_t{vertical[x]} * vertical[x]);
    }
    for (int x = span.first; x <= span.last; ++x) {
      const std::int64_t squared = envelope.at(x);
      const double metres = squared == LowerEnvelope::kNone
                                ? params_.max_distance
                                : resolution_ * std::sqrt(static_cast<double>(squared));
      distance_[row + static_cast<std::size_t>(x)] =
          static_cast<float>(std::min(metres, params_.max_distance));
    }
  }
}

double DistanceField::distance_at(const Eigen::Vector2d& point) const {
  if (empty()) return params_.max_distance;
  if (!point.allFinite()) return 0.0;
  const Eigen::Vector2d cells = (point - origin_) / resolution_;
  const double x = std::clamp(cells.x() - 0.5, 0.0, static_cast<double>(width_ - 1));
  const double y = std::clamp(cells.y() - 0.5, 0.0, static_cast<double>(height_ - 1));
  const int x0 = std::min(static_cast<int>(x), std::max(0, width_ - 2));
  const int y0 = std::min(static_cast<int>(y), std::max(0, height_ - 2));
  const int x1 = std::min(x0 + 1, width_ - 1), y1 = std::min(y0 + 1, height_ - 1);
  const double u = x - x0, v = y - y0;
  const double below = (1.0 - u) * distance({x0, y0}) + u * distance({x1, y0});
  const double above = (1.0 - u) * distance({x0, y1}) + u * distance({x1, y1});
  return (1.0 - v) * below + v * above;
}

}  // namespace swiftlet
