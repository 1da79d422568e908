// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/occupancy_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

namespace swiftlet {
namespace {

// Rays are traversed in whole numbers, of this many parts of a cell.
constexpr int kSubcellBits = 12;
constexpr std::int64_t kSubcell = std::int64_t{1} << kSubcellBits;
// The grid grows in steps, so that it is not copied with every scan.
constexpr std::int64_t kGrowthStep = 64;
// Beyond, the position of a cell could not be told in doubles.
constexpr double kFarthestCell = 1e9;

constexpr std::uint8_t kMissed = 1;
constexpr std::uint8_t kHit = 2;

std::int16_t evidence_of(double probability) {
  const double p = std::clamp(probability, 1e-9, 1.0 - 1e-9);
  return static_cast<std::int16_t>(
      std::lround(OccupancyGrid::kEvidencePerLogOdds * std::log(p / (1.0 - p))));
}

bool is_probability(double p) {
  return p > 0.0 && p < 1.0;
}

inline CellState state_of(std::int16_t evidence, std::int16_t occupied_above,
                          std::int16_t free_below) {
  const bool occupied = evidence > occupied_above;
  const bool free = evidence < free_below && evidence != OccupancyGrid::kNoEvidence;
  const CellState known = occupied ? CellState::kOccupied : CellState::kUnknown;
  return free ? CellState::kFree : known;
}

std::int64_t floor_to_step(std::int64_t cells, std::int64_t step) {
  return (cells >= 0 ? cells : cells - (step - 1)) / step * step;
}

/// Marks every cell whose interior the segment crosses, and the cells of its two ends (Amanatides
/// and Woo 1987, in integers). Through a corner it steps diagonally.
void mark_ray(std::uint8_t* touched, std::int64_t stride, std::int64_t x0, std::int64_t y0,
              std::int64_t x1, std::int64_t y1) {
  const std::int64_t cx = x0 >> kSubcellBits, cy = y0 >> kSubcellBits;
  std::int64_t steps_x = std::abs((x1 >> kSubcellBits) - cx);
  std::int64_t steps_y = std::abs((y1 >> kSubcellBits) - cy);
  const std::int64_t dx = std::abs(x1 - x0), dy = std::abs(y1 - y0);
  const std::int64_t move_x = x1 > x0 ? 1 : -1;
  const std::int64_t move_y = y1 > y0 ? stride : -stride;
  // Times to the next boundary of a column and of a row, both multiplied by dx * dy.
  std::int64_t next_x =
      dy * (x1 > x0 ? ((cx + 1) << kSubcellBits) - x0 : x0 - (cx << kSubcellBits));
  std::int64_t next_y =
      dx * (y1 > y0 ? ((cy + 1) << kSubcellBits) - y0 : y0 - (cy << kSubcellBits));
  const std::int64_t column = dy << kSubcellBits, row = dx << kSubcellBits;

  std::uint8_t* cell = touched + cy * stride + cx;
  *cell |= kMissed;
  while (steps_x > 0 && steps_y > 0) {
    const bool along_x = next_x <= next_y;
    const bool along_y = next_y <= next_x;
    cell += along_x ? move_x : 0;
    cell += along_y ? move_y : 0;
    next_x += along_x ? column : 0;
    next_y += along_y ? row : 0;
    steps_x -= along_x;
    steps_y -= along_y;
    *cell |= kMissed;
  }
  for (; steps_x > 0; --steps_x) *(cell += move_x) |= kMissed;
  for (; steps_y > 0; --steps_y) *(cell += move_y) |= kMissed;
}

}  // namespace

struct OccupancyGrid::Segment {
  Eigen::Vector2d from, to;  // [m]
  bool hit;
};

OccupancyGrid::OccupancyGrid() : OccupancyGrid(Params{}) {}

OccupancyGrid::OccupancyGrid(const Params& params) : params_(params) {
  set_thresholds();
}

OccupancyGrid::OccupancyGrid(const Params& params, const Eigen::Vector2d& origin, int width,
                             int height)
    : OccupancyGrid(params) {
  if (!usable_ || !origin.allFinite() || width <= 0 || height <= 0) return;
  if (static_cast<std::int64_t>(width) * height > params.max_cells) return;
  anchor_ = origin;
  width_ = width;
  height_ = height;
  evidence_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kNoEvidence);
}

void OccupancyGrid::set_thresholds() {
  const Params& p = params_;
  usable_ = std::isfinite(p.resolution) && p.resolution > 0.0 &&
            is_probability(p.hit_probability) && is_probability(p.miss_probability) &&
            is_probability(p.min_probability) && is_probability(p.max_probability) &&
            p.min_probability < p.max_probability && is_probability(p.free_threshold) &&
            is_probability(p.occupied_threshold) && p.free_threshold <= p.occupied_threshold &&
            p.min_height <= p.max_height && p.max_range > 0.0;
  if (!usable_) return;
  hit_ = evidence_of(p.hit_probability);
  miss_ = evidence_of(p.miss_probability);
  occupied_above_ = evidence_of(p.occupied_threshold);
  free_below_ = evidence_of(p.free_threshold);
  // What is clamped must still be able to count as free or occupied.
  min_ = std::min<std::int16_t>(evidence_of(p.min_probability), free_below_ - 1);
  max_ = std::max<std::int16_t>(evidence_of(p.max_probability), occupied_above_ + 1);
}

Eigen::Vector2d OccupancyGrid::origin() const {
  return anchor_ + params_.resolution * Eigen::Vector2d(static_cast<double>(first_x_),
                                                        static_cast<double>(first_y_));
}

Cell OccupancyGrid::cell_of(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d cells = (point - origin()) / params_.resolution;
  const auto index = [](double coordinate) {
    if (!(std::abs(coordinate) < kFarthestCell)) return -1;
    return static_cast<int>(std::floor(coordinate));
  };
  return {index(cells.x()), index(cells.y())};
}

Eigen::Vector2d OccupancyGrid::center_of(Cell cell) const {
  return origin() + params_.resolution * Eigen::Vector2d(cell.x + 0.5, cell.y + 0.5);
}

CellState OccupancyGrid::state(Cell cell) const {
  if (!contains(cell)) return CellState::kUnknown;
  return state_of(evidence_[index(cell)], occupied_above_, free_below_);
}

void OccupancyGrid::states_of_row(int y, std::vector<CellState>& states) const {
  states.resize(static_cast<std::size_t>(width_));
  const std::int16_t* evidence = evidence_.data() + index({0, y});
  const std::int16_t occupied_above = occupied_above_, free_below = free_below_;
  CellState* state = states.data();
  for (int x = 0; x < width_; ++x) state[x] = state_of(evidence[x], occupied_above, free_below);
}

double OccupancyGrid::probability(Cell cell) const {
  if (!contains(cell) || evidence_[index(cell)] == kNoEvidence) return 0.5;
  return 1.0 / (1.0 + std::exp(-evidence_[index(cell)] / kEvidencePerLogOdds));
}

void OccupancyGrid::set_state(Cell cell, CellState state) {
  if (!contains(cell)) return;
  evidence_[index(cell)] = state == CellState::kOccupied ? max_
                           : state == CellState::kFree   ? min_
                                                         : kNoEvidence;
}

void OccupancyGrid::set_probability(Cell cell, double probability) {
  if (!contains(cell)) return;
  evidence_[index(cell)] =
      std::isnan(probability) ? kNoEvidence : std::clamp(evidence_of(probability), min_, max_);
}

void OccupancyGrid::set_percents(const std::vector<std::int8_t>& percents) {
  if (percents.size() != evidence_.size()) return;
  std::size_t index = 0;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const std::int8_t percent = percents[index++];
      set_probability({x, y}, percent < 0 ? NAN : percent / 100.0);
    }
  }
}

Status OccupancyGrid::cover(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper) {
  return cover_box(lower, upper, 1);
}

Status OccupancyGrid::cover_box(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper,
                                std::int64_t step) {
  if (!usable_) return Error{"the parameters of the occupancy grid are out of range"};
  if (!lower.allFinite() || !upper.allFinite()) {
    return Error{"the area that the occupancy grid should cover is not finite"};
  }
  const Eigen::Vector2d low = (lower.cwiseMin(upper) - anchor_) / params_.resolution;
  const Eigen::Vector2d high = (lower.cwiseMax(upper) - anchor_) / params_.resolution;
  if (!(low.cwiseAbs().maxCoeff() < kFarthestCell && high.cwiseAbs().maxCoeff() < kFarthestCell)) {
    return Error{
        fmt::format("({:.6g}, {:.6g}) m is too far away for an occupancy grid of {} m cells",
                    upper.x(), upper.y(), params_.resolution)};
  }
  const auto cell = [](double coordinate) {
    return static_cast<std::int64_t>(std::floor(coordinate));
  };
  return cover_cells(cell(low.x()), cell(low.y()), cell(high.x()), cell(high.y()), step);
}

Status OccupancyGrid::cover_cells(std::int64_t x0, std::int64_t y0, std::int64_t x1,
                                  std::int64_t y1, std::int64_t step) {
  std::int64_t left = first_x_, bottom = first_y_;
  std::int64_t right = first_x_ + width_, top = first_y_ + height_;
  if (empty()) {
    left = right = floor_to_step(x0, step);
    bottom = top = floor_to_step(y0, step);
  }
  if (!empty() && x0 >= left && y0 >= bottom && x1 < right && y1 < top) return {};
  if (x0 < left) left = floor_to_step(x0, step);
  if (y0 < bottom) bottom = floor_to_step(y0, step);
  if (x1 >= right) right = floor_to_step(x1, step) + step;
  if (y1 >= top) top = floor_to_step(y1, step) + step;

  const std::int64_t width = right - left, height = top - bottom;
  if (width > params_.max_cells || height > params_.max_cells ||
      width * height > params_.max_cells) {
    return Error{fmt::format(
        "the occupancy grid would have to grow to {} x {} cells, more than its limit of {}", width,
        height, params_.max_cells)};
  }
  std::vector<std::int16_t> grown(static_cast<std::size_t>(width * height), kNoEvidence);
  for (int y = 0; y < height_; ++y) {
    const auto row = evidence_.begin() + static_cast<std::ptrdiff_t>(y) * width_;
    std::copy(row, row + width_,
              grown.begin() + (first_y_ - bottom + y) * width + (first_x_ - left));
  }
  evidence_ = std::move(grown);
  first_x_ = left;
  first_y_ = bottom;
  width_ = static_cast<int>(width);
  height_ = static_cast<int>(height);
  return {};
}

namespace {

/// The part of a beam from `from` to `to` metres along it that is inside the height band, or
/// nothing. `rise` is metres of height per metre of the beam.
struct Span {
  double from, to;
};
std::optional<Span> clip_to_band(double length, double height, double rise, double min_height,
                                 double max_height) {
  Span span{0.0, length};
  if (rise == 0.0) {
    if (height < min_height || height > max_height) return std::nullopt;
    return span;
  }
  const double at_min = (min_height - height) / rise, at_max = (max_height - height) / rise;
  span.from = std::max(span.from, std::min(at_min, at_max));
  span.to = std::min(span.to, std::max(at_min, at_max));
  if (!(span.from <= span.to)) return std::nullopt;
  return span;
}

Status check(const LaserScan& scan, const Eigen::Vector3d& p_WL, const Eigen::Quaterniond& q_WL) {
  if (!p_WL.allFinite() || !q_WL.coeffs().allFinite() || !(q_WL.norm() > 1e-6)) {
    return Error{"the pose of the laser scanner is not finite or its attitude has no length"};
  }
  if (!std::isfinite(scan.angle_min) || !std::isfinite(scan.angle_increment) ||
      !(std::abs(scan.angle_min) < 1e6) || !(std::abs(scan.angle_increment) < 1e3)) {
    return Error{"the angles of the laser scan are not finite"};
  }
  if (!std::isfinite(scan.range_min) || !std::isfinite(scan.range_max) || scan.range_min < 0.0 ||
      scan.range_max <= scan.range_min) {
    return Error{fmt::format("the laser scan claims ranges from {} m to {} m", scan.range_min,
                             scan.range_max)};
  }
  return {};
}

}  // namespace

Result<ScanInsertion> OccupancyGrid::insert(const LaserScan& scan, const Eigen::Vector3d& p_WL,
                                            const Eigen::Quaterniond& q_WL) {
  if (!usable_) return Error{"the parameters of the occupancy grid are out of range"};
  if (Status status = check(scan, p_WL, q_WL); !status) return status.error();

  // Level the beams, and cut out of each what is inside the height band.
  const Eigen::Matrix3d R_WL = q_WL.normalized().toRotationMatrix();
  const double reach = std::min(scan.range_max, params_.max_range);
  ScanInsertion result;
  std::vector<Segment> segments;
  segments.reserve(scan.ranges.size());
  Eigen::Vector2d lower = p_WL.head<2>(), upper = lower;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = static_cast<double>(scan.ranges[i]);
    if (std::isnan(range) || range < scan.range_min) {
      ++result.ignored;
      continue;
    }
    const bool returned = range < scan.range_max && range <= params_.max_range;
    if (!returned && range >= scan.range_max && !params_.clear_without_return) {
      ++result.ignored;
      continue;
    }
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    const Eigen::Vector3d direction = R_WL.col(0) * std::cos(angle) + R_WL.col(1) * std::sin(angle);
    const double length = returned ? range : reach;
    const auto span =
        clip_to_band(length, p_WL.z(), direction.z(), params_.min_height, params_.max_height);
    if (!span) {
      ++result.ignored;
      continue;
    }
    const Segment segment{p_WL.head<2>() + span->from * direction.head<2>(),
                          p_WL.head<2>() + span->to * direction.head<2>(),
                          returned && span->to == length};
    lower = lower.cwiseMin(segment.from).cwiseMin(segment.to);
    upper = upper.cwiseMax(segment.from).cwiseMax(segment.to);
    ++(segment.hit ? result.returns : result.clearing);
    segments.push_back(segment);
  }
  if (segments.empty()) return result;
  if (Status status = cover_box(lower, upper, kGrowthStep); !status) return status.error();

  // Trace them in whole numbers inside a box of their own.
  const Cell low = cell_of(lower), high = cell_of(upper);
  // One cell of slack: rounding to parts of a cell may carry a point over the edge of the box.
  const std::int64_t box_width = high.x - low.x + 3, box_height = high.y - low.y + 3;
  touched_.assign(static_cast<std::size_t>(box_width * box_height), 0);
  const Eigen::Vector2d corner =
      origin() + params_.resolution * Eigen::Vector2d(low.x - 1, low.y - 1);
  const auto parts = [&](double metres) {
    return static_cast<std::int64_t>(
        std::llround(metres / params_.resolution * static_cast<double>(kSubcell)));
  };
  for (const Segment& segment : segments) {
    const Eigen::Vector2d a = segment.from - corner, b = segment.to - corner;
    const std::int64_t x1 = parts(b.x()), y1 = parts(b.y());
    mark_ray(touched_.data(), box_width, parts(a.x()), parts(a.y()), x1, y1);
    if (segment.hit) {
      touched_[static_cast<std::size_t>((y1 >> kSubcellBits) * box_width + (x1 >> kSubcellBits))] |=
          kHit;
    }
  }

  // One update a cell.
  const int box_left = low.x - 1, box_bottom = low.y - 1;
  const int from_x = std::max(0, box_left);
  const int to_x = std::min<int>(width_, box_left + static_cast<int>(box_width));
  for (int y = std::max(0, box_bottom);
       y < std::min<int>(height_, box_bottom + static_cast<int>(box_height)); ++y) {
    const std::uint8_t* touched = touched_.data() + (y - box_bottom) * box_width - box_left;
    std::int16_t* evidence = evidence_.data() + static_cast<std::ptrdiff_t>(y) * width_;
    for (int x = from_x; x < to_x; ++x) {
      if (touched[x] == 0) continue;
      const int before = evidence[x] == kNoEvidence ? 0 : evidence[x];
      const int after = before + ((touched[x] & kHit) != 0 ? hit_ : miss_);
      evidence[x] = static_cast<std::int16_t>(std::clamp<int>(after, min_, max_));
    }
  }
  return result;
}

}  // namespace swiftlet
