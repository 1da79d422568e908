// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/path/fast_marching_tree.hpp"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSampler.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/datastructures/NearestNeighbors.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/fmt/FMT.h>
#include <ompl/util/Console.h>
#include <ompl/util/Exception.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace swiftlet {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

// Of FMT*'s neighbourhoods: about 14 neighbours among 500 samples.
constexpr double kRadiusMultiplier = 0.8;
// Checks of the termination condition, of which there is about one a sample and expansion.
constexpr int kMaxChecksPerSample = 20;

Eigen::Vector2d point_of(const ob::State* state) {
  const auto* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
  return {values[0], values[1]};
}

void set_point(ob::State* state, const Eigen::Vector2d& point) {
  auto* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
  values[0] = point.x();
  values[1] = point.y();
}

class Validity : public ob::StateValidityChecker {
 public:
  Validity(const ob::SpaceInformationPtr& space, const ClearanceMap& map)
      : ob::StateValidityChecker(space), map_(map) {}
  bool isValid(const ob::State* state) const override {
    return map_.clearance_at(point_of(state)) >= map_.cost().hard_clearance();
  }

 private:
  const ClearanceMap& map_;
};

/// A straight motion is valid exactly where its cost is finite.
class StraightMotion : public ob::MotionValidator {
 public:
  StraightMotion(const ob::SpaceInformationPtr& space, const ClearanceMap& map)
      : ob::MotionValidator(space), map_(map) {}
  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    return std::isfinite(map_.segment_cost(point_of(a), point_of(b)));
  }
  bool checkMotion(const ob::State* a, const ob::State* b,
                   std::pair<ob::State*, double>& last_valid) const override {
    last_valid.second = 0.0;
    if (last_valid.first != nullptr) si_->copyState(last_valid.first, a);
    return checkMotion(a, b);
  }

 private:
  const ClearanceMap& map_;
};

class ClearanceObjective : public ob::OptimizationObjective {
 public:
  ClearanceObjective(const ob::SpaceInformationPtr& space, const ClearanceMap& map)
      : ob::OptimizationObjective(space), map_(map) {}
  ob::Cost stateCost(const ob::State* state) const override {
    return ob::Cost(map_.density_at(point_of(state)));
  }
  ob::Cost motionCost(const ob::State* a, const ob::State* b) const override {
    return ob::Cost(map_.segment_cost(point_of(a), point_of(b)));
  }
  ob::Cost motionCostHeuristic(const ob::State* a, const ob::State* b) const override {
    return ob::Cost((point_of(b) - point_of(a)).norm());
  }

 private:
  const ClearanceMap& map_;
};

/// Draws from the cells that the flood fill reached: anywhere, on the ridge of narrow passages, and
/// around the fill's own way to the goal.
class FillSampler : public ob::StateSampler {
 public:
  FillSampler(const ob::StateSpace* space, const ClearanceMap& map, const FloodFill& fill,
              const FastMarchingTreeParams& params, std::uint32_t seed)
      : ob::StateSampler(space), map_(map), fill_(fill), params_(params), random_(seed) {}

  void sampleUniform(ob::State* state) override {
    const double kind = random_.uniform01();
    const double drawn = random_.uniform01();
    const double u = random_.uniformReal(-1.0, 1.0), v = random_.uniformReal(-1.0, 1.0);
    const Eigen::Vector2d offset(u, v);
    const auto one_of = [&](const std::vector<Cell>& cells) {
      const auto i = static_cast<std::size_t>(drawn * static_cast<double>(cells.size()));
      return map_.center_of(cells[std::min(i, cells.size() - 1)]);
    };
    Eigen::Vector2d center;
    double reach = 0.5 * map_.resolution();
    if (kind < params_.guided_share) {
      center = one_of(fill_.to_goal);
      reach = params_.guide_width;
    } else if (kind < params_.guided_share + params_.ridge_share && !fill_.narrow.empty()) {
      center = one_of(fill_.narrow);
    } else {
      center = one_of(fill_.reached);
    }
    const Eigen::Vector2d point = center + reach * offset;
    const bool good =
        map_.contains(point) && map_.clearance_at(point) >= map_.cost().hard_clearance();
    set_point(state, good ? point : center);
  }
  void sampleUniformNear(ob::State* state, const ob::State*, double) override {
    sampleUniform(state);
  }
  void sampleGaussian(ob::State* state, const ob::State*, double) override { sampleUniform(state); }

 private:
  const ClearanceMap& map_;
  const FloodFill& fill_;
  FastMarchingTreeParams params_;
  ompl::RNG random_;
};

/// Exact Euclidean neighbours in the plane from square buckets, nearest first, ties by age.
///
/// OMPL's own trees take the cost of motions for a metric, which it is not, and choose their pivots
/// at random from a seed of the whole process.
template <class Node>
class PlanarNeighbors : public ompl::NearestNeighbors<Node> {
 public:
  PlanarNeighbors(const Eigen::Vector2d& origin, const Eigen::Vector2d& size, double bucket)
      : origin_(origin),
        bucket_(bucket),
        columns_(1 + static_cast<int>(size.x() / bucket)),
        rows_(1 + static_cast<int>(size.y() / bucket)),
        buckets_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

  bool reportsSortedResults() const override { return true; }
  void clear() override {
    for (auto& bucket : buckets_) bucket.clear();
    nodes_.clear();
  }
  void add(const Node& node) override {
    at(column(point(node)), row(point(node))).push_back(nodes_.size());
    nodes_.push_back(node);
  }
  void add(const std::vector<Node>& nodes) override {
    for (const Node& node : nodes) add(node);
  }
  bool remove(const Node&) override { return false; }  // FMT* never does
  Node nearest(const Node& node) const override {
    std::vector<Node> result;
    nearestK(node, 1, result);
    if (result.empty()) throw ompl::Exception("no neighbours");
    return result[0];
  }
  void nearestK(const Node& node, std::size_t k, std::vector<Node>& result) const override {
    std::vector<Found> found;
    const int rings = std::max(columns_, rows_);
    for (int ring = 0; ring <= rings; ++ring) {
      search_ring(point(node), ring, found);
      // All buckets up to this ring hold everything within `ring` edges of a bucket.
      const double covered = ring * bucket_;
      const auto sure = std::count_if(found.begin(), found.end(),
                                      [&](const Found& f) { return f.first <= covered * covered; });
      if (static_cast<std::size_t>(sure) >= k) break;
    }
    std::sort(found.begin(), found.end());
    found.resize(std::min(found.size(), k));
    take(found, result);
  }
  void nearestR(const Node& node, double radius, std::vector<Node>& result) const override {
    std::vector<Found> found;
    const int rings =
        std::min(std::max(columns_, rows_), 1 + static_cast<int>(std::ceil(radius / bucket_)));
    for (int ring = 0; ring <= rings; ++ring) search_ring(point(node), ring, found);
    found.erase(std::remove_if(found.begin(), found.end(),
                               [&](const Found& f) { return f.first > radius * radius; }),
                found.end());
    std::sort(found.begin(), found.end());
    take(found, result);
  }
  std::size_t size() const override { return nodes_.size(); }
  void list(std::vector<Node>& nodes) const override { nodes = nodes_; }

 private:
  using Found = std::pair<double, std::size_t>;  // squared distance, number of the node

  static Eigen::Vector2d point(const Node& node) { return point_of(node->getState()); }
  int column(const Eigen::Vector2d& p) const {
    return std::clamp(static_cast<int>((p.x() - origin_.x()) / bucket_), 0, columns_ - 1);
  }
  int row(const Eigen::Vector2d& p) const {
    return std::clamp(static_cast<int>((p.y() - origin_.y()) / bucket_), 0, rows_ - 1);
  }
  std::vector<std::size_t>& at(int x, int y) {
    return buckets_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(x)];
  }
  void search_ring(const Eigen::Vector2d& p, int ring, std::vector<Found>& found) const {
    const int cx = column(p), cy = row(p);
    for (int y = std::max(0, cy - ring); y <= std::min(rows_ - 1, cy + ring); ++y) {
      const bool whole = std::abs(y - cy) == ring;
      for (int x = cx - ring; x <= cx + ring; x += (whole || ring == 0) ? 1 : 2 * ring) {
        if (x < 0 || x >= columns_) continue;
        for (const std::size_t i :
             buckets_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                      static_cast<std::size_t>(x)]) {
          found.emplace_back((point(nodes_[i]) - p).squaredNorm(), i);
        }
      }
    }
  }
  void take(const std::vector<Found>& found, std::vector<Node>& result) const {
    result.clear();
    for (const Found& f : found) result.push_back(nodes_[f.second]);
  }

  Eigen::Vector2d origin_;
  double bucket_;
  int columns_, rows_;
  std::vector<std::vector<std::size_t>> buckets_;
  std::vector<Node> nodes_;
};

class PlanarFmt : public og::FMT {
 public:
  PlanarFmt(const ob::SpaceInformationPtr& space, const ClearanceMap& map, int samples)
      : og::FMT(space) {
    const Eigen::Vector2d size = map.resolution() * Eigen::Vector2d(map.width(), map.height());
    // About two samples a bucket.
    const double bucket = std::max(4 * map.resolution(), std::sqrt(2 * size.prod() / samples));
    nn_ = std::make_shared<PlanarNeighbors<Motion*>>(map.origin(), size, bucket);
    setNumSamples(static_cast<unsigned>(samples));
    setNearestK(true);
    setRadiusMultiplier(kRadiusMultiplier);
    setExtendedFMT(false);
    setCacheCC(false);
  }
};

}  // namespace

Polyline fast_marching_tree(const ClearanceMap& map, const FloodFill& fill,
                            const Eigen::Vector2d& start, const Eigen::Vector2d& goal,
                            const FastMarchingTreeParams& params, std::uint32_t seed) {
  if (fill.to_goal.empty() || params.samples <= 0) return {};
  // What OMPL has to say is for its developers; the result says what matters.
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);

  const auto plane = std::make_shared<ob::RealVectorStateSpace>(2);
  ob::RealVectorBounds bounds(2);
  for (unsigned i = 0; i < 2; ++i) {
    const int axis = static_cast<int>(i);
    bounds.setLow(i, map.origin()[axis]);
    bounds.setHigh(i,
                   map.origin()[axis] + map.resolution() * (i == 0 ? map.width() : map.height()));
  }
  plane->setBounds(bounds);
  plane->setStateSamplerAllocator([&](const ob::StateSpace* space) {
    return std::make_shared<FillSampler>(space, map, fill, params, seed);
  });
  const auto space = std::make_shared<ob::SpaceInformation>(plane);
  space->setStateValidityChecker(std::make_shared<Validity>(space, map));
  space->setMotionValidator(std::make_shared<StraightMotion>(space, map));
  space->setup();

  ob::ScopedState<> from(plane), to(plane);
  set_point(from.get(), start);
  set_point(to.get(), goal);
  const auto problem = std::make_shared<ob::ProblemDefinition>(space);
  problem->setStartAndGoalStates(from, to);
  problem->setOptimizationObjective(std::make_shared<ClearanceObjective>(space, map));

  PlanarFmt planner(space, map, params.samples);
  planner.setProblemDefinition(problem);
  planner.setup();
  int checks = 0;
  const int max_checks = kMaxChecksPerSample * params.samples;
  const ob::PlannerTerminationCondition enough([&] { return ++checks > max_checks; });
  if (planner.solve(enough) != ob::PlannerStatus::EXACT_SOLUTION) return {};

  const auto path = std::dynamic_pointer_cast<og::PathGeometric>(problem->getSolutionPath());
  if (!path) return {};
  Polyline line;
  for (const ob::State* state : path->getStates()) line.push_back(point_of(state));
  return line;
}

}  // namespace swiftlet
