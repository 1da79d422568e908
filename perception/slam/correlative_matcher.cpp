// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/correlative_matcher.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet {
namespace {

using Eigen::Vector2d;

constexpr int kWhole = 255;

}  // namespace

LikelihoodField::LikelihoodField(const std::vector<Vector2d>& points, const Params& params)
    : params_(params) {
  const int reach = static_cast<int>(std::ceil(3.0 * params.sigma / params.resolution));
  Vector2d lower = Vector2d::Zero(), upper = Vector2d::Zero();
  if (!points.empty()) lower = upper = points.front();
  for (const Vector2d& p : points) lower = lower.cwiseMin(p), upper = upper.cwiseMax(p);
  origin_ = lower - Vector2d::Constant((reach + 1) * params.resolution);
  levels_.resize(static_cast<std::size_t>(params.levels));
  Level& fine = levels_.front();
  const Vector2d size = (upper - origin_) / params.resolution;
  fine.width = static_cast<int>(size.x()) + reach + 2;
  fine.height = static_cast<int>(size.y()) + reach + 2;
  fine.values.assign(static_cast<std::size_t>(fine.width) * static_cast<std::size_t>(fine.height),
                     0);
  // A kernel for the place of a point within its cell would be finer than what follows needs.
  const int side = 2 * reach + 1;
  std::vector<std::uint8_t> kernel(static_cast<std::size_t>(side * side));
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const double d = params.resolution * std::hypot(x, y) / params.sigma;
      kernel[static_cast<std::size_t>((y + reach) * side + x + reach)] =
          static_cast<std::uint8_t>(std::lround(kWhole * std::exp(-0.5 * d * d)));
    }
  }
  std::vector<bool> stamped(fine.values.size(), false);
  for (const Vector2d& p : points) {
    const int cx = static_cast<int>((p.x() - origin_.x()) / params.resolution);
    const int cy = static_cast<int>((p.y() - origin_.y()) / params.resolution);
    const std::size_t cell = static_cast<std::size_t>(cy) * static_cast<std::size_t>(fine.width) +
                             static_cast<std::size_t>(cx);
    if (stamped[cell]) continue;
    stamped[cell] = true;
    for (int y = 0; y < side; ++y) {
      std::uint8_t* row = fine.values.data() +
                          static_cast<std::ptrdiff_t>(cy + y - reach) * fine.width + cx - reach;
      const std::uint8_t* of_kernel = kernel.data() + y * side;
      for (int x = 0; x < side; ++x) row[x] = std::max(row[x], of_kernel[x]);
    }
  }
  // Level l at (x, y) is the maximum of four of level l - 1, half its reach apart.
  for (int l = 1; l < params.levels; ++l) {
    const Level& below = levels_[static_cast<std::size_t>(l) - 1];
    Level& level = levels_[static_cast<std::size_t>(l)];
    const int step = 1 << (l - 1);
    level.width = below.width + step;
    level.height = below.height + step;
    level.values.assign(
        static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height), 0);
    for (int y = 0; y < below.height; ++y) {
      const std::uint8_t* from = below.values.data() + static_cast<std::ptrdiff_t>(y) * below.width;
      for (const int dy : {0, step}) {
        std::uint8_t* to = level.values.data() + static_cast<std::ptrdiff_t>(y + dy) * level.width;
        for (int x = 0; x < below.width; ++x) to[x] = std::max(to[x], from[x]);
        for (int x = 0; x < below.width; ++x) to[x + step] = std::max(to[x + step], from[x]);
      }
    }
  }
}

namespace {

struct CellOffset {
  int x, y;
};

/// The search of one window.
class Search {
 public:
  Search(const LikelihoodField& field, const std::vector<Vector2d>& points, const Pose2& guess,
         const SearchWindow& window)
      : field_(field), points_(points), guess_(guess), window_(window), best_(window.least_score) {}

  std::optional<CorrelativeMatch> run() {
    if (points_.empty()) return std::nullopt;
    double reach = field_.resolution();
    for (const Vector2d& p : points_) reach = std::max(reach, p.norm());
    // So small that no point moves by more than a cell from one to the next.
    const double step = field_.resolution() / reach;
    const int turns = static_cast<int>(std::ceil(window_.angle / step));
    const int cells = static_cast<int>(std::ceil(window_.distance / field_.resolution()));
    int top = 0;
    while (top + 1 < field_.levels() && (2 << top) <= 2 * cells + 1) ++top;

    std::vector<Candidate> candidates;
    rotated_.resize(static_cast<std::size_t>(2 * turns + 1));
    for (int turn = -turns; turn <= turns; ++turn) {
      const double angle = turns == 0 ? 0.0 : turn * window_.angle / turns;
      rotate(turn + turns, guess_.yaw + angle);
      const double relative = window_.angle > 0.0 ? angle / window_.angle : 0.0;
      const double penalty = window_.angle_penalty * relative * relative;
      if (1.0 - penalty <= best_) continue;
      for (int y = -cells; y <= cells; y += 1 << top) {
        for (int x = -cells; x <= cells; x += 1 << top) {
          Candidate c{turn + turns, x, y, penalty, 0.0};
          c.bound = bound(c, top, cells);
          if (c.bound > best_) candidates.push_back(c);
        }
      }
    }
    descend_best_first(candidates, top, cells);
    if (!found_) return std::nullopt;
    const double angle = turns == 0 ? 0.0 : (found_->turn - turns) * window_.angle / turns;
    CorrelativeMatch match;
    match.pose.position = guess_.position + field_.resolution() * Vector2d(found_->x, found_->y);
    match.pose.yaw = wrap_angle(guess_.yaw + angle);
    match.score = likelihood(*found_, 0);
    return match;
  }

 private:
  struct Candidate {
    int turn, x, y;
    double angle_penalty;
    double bound;
  };

  void rotate(int index, double yaw) {
    auto& cells = rotated_[static_cast<std::size_t>(index)];
    cells.reserve(points_.size());
    const Eigen::Rotation2Dd R(yaw);
    for (const Vector2d& p : points_) {
      const Vector2d cell = (guess_.position + R * p - field_.origin()) / field_.resolution();
      cells.push_back(
          {static_cast<int>(std::floor(cell.x())), static_cast<int>(std::floor(cell.y()))});
    }
  }

  double likelihood(const Candidate& c, int level) const {
    int sum = 0;
    for (const CellOffset& cell : rotated_[static_cast<std::size_t>(c.turn)]) {
      sum += field_.at(level, cell.x + c.x, cell.y + c.y);
    }
    return sum / (static_cast<double>(kWhole) * static_cast<double>(points_.size()));
  }

  /// Nothing among the 2^level by 2^level offsets from the candidate's on is better.
  double bound(const Candidate& c, int level, int cells) const {
    const int size = (1 << level) - 1;
    const auto nearest = [size](int from) { return from > 0 ? from : std::min(0, from + size); };
    const double dx = nearest(c.x), dy = nearest(c.y);
    const double relative =
        cells > 0 ? (dx * dx + dy * dy) / (static_cast<double>(cells) * cells) : 0.0;
    return likelihood(c, level) - c.angle_penalty - window_.distance_penalty * relative;
  }

  void descend(const Candidate& c, int level, int cells) {
    if (level == 0) {
      best_ = c.bound;
      found_ = c;
      return;
    }
    const int step = 1 << (level - 1);
    std::vector<Candidate> children;
    children.reserve(4);
    for (const int dy : {0, step}) {
      for (const int dx : {0, step}) {
        Candidate child{c.turn, c.x + dx, c.y + dy, c.angle_penalty, 0.0};
        if (child.x > cells || child.y > cells) continue;
        child.bound = bound(child, level - 1, cells);
        if (child.bound > best_) children.push_back(child);
      }
    }
    descend_best_first(children, level - 1, cells);
  }

  void descend_best_first(std::vector<Candidate>& candidates, int level, int cells) {
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.bound > b.bound; });
    for (const Candidate& c : candidates) {
      if (c.bound <= best_) break;
      descend(c, level, cells);
    }
  }

  const LikelihoodField& field_;
  const std::vector<Vector2d>& points_;
  const Pose2& guess_;
  const SearchWindow& window_;
  double best_;
  std::optional<Candidate> found_;
  std::vector<std::vector<CellOffset>> rotated_;
};

}  // namespace

std::optional<CorrelativeMatch> find_best_match(const LikelihoodField& field,
                                                const std::vector<Vector2d>& points,
                                                const Pose2& guess, const SearchWindow& window) {
  return Search(field, points, guess, window).run();
}

}  // namespace swiftlet
