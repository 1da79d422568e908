// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/planning/ompl_peers.hpp"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

namespace swiftlet {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

unsigned dimension_of(const VoxelGrid& grid) {
  return grid.size_z() == 1 ? 2 : 3;
}

Eigen::Vector3d point_of(const ob::State* state, unsigned dimension) {
  const auto* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
  return {values[0], values[1], dimension == 2 ? 0.5 : values[2]};
}

class ExactMotion : public ob::MotionValidator {
 public:
  ExactMotion(const ob::SpaceInformationPtr& space, const VoxelGrid& grid)
      : ob::MotionValidator(space), grid_(grid) {}
  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    const unsigned dimension = si_->getStateDimension();
    return line_is_free(grid_, point_of(a, dimension), point_of(b, dimension));
  }
  bool checkMotion(const ob::State* a, const ob::State* b,
                   std::pair<ob::State*, double>& last_valid) const override {
    last_valid.second = 0.0;
    if (last_valid.first != nullptr) si_->copyState(last_valid.first, a);
    return checkMotion(a, b);
  }

 private:
  const VoxelGrid& grid_;
};

}  // namespace

SpaceLine plan_with_ompl(OmplPeer peer, const VoxelGrid& grid, Voxel start, Voxel goal,
                         double limit_s) {
  ompl::msg::noOutputHandler();
  const unsigned dimension = dimension_of(grid);
  auto space = std::make_shared<ob::RealVectorStateSpace>(dimension);
  ob::RealVectorBounds bounds(dimension);
  bounds.setLow(0.0);
  bounds.setHigh(0, grid.size_x());
  bounds.setHigh(1, grid.size_y());
  if (dimension == 3) bounds.setHigh(2, grid.size_z());
  space->setBounds(bounds);
  og::SimpleSetup setup(space);
  setup.setStateValidityChecker([&grid, dimension](const ob::State* state) {
    const Eigen::Vector3d point = point_of(state, dimension);
    return line_is_free(grid, point, point);
  });
  const auto& information = setup.getSpaceInformation();
  information->setMotionValidator(std::make_shared<ExactMotion>(information, grid));
  const auto state_at = [&](Voxel voxel) {
    ob::ScopedState<> state(space);
    const Eigen::Vector3d center = center_of(voxel);
    for (unsigned i = 0; i < dimension; ++i) state[i] = center[i];
    return state;
  };
  setup.setStartAndGoalStates(state_at(start), state_at(goal));
  if (peer == OmplPeer::kBitStar) {
    setup.setOptimizationObjective(
        std::make_shared<ob::PathLengthOptimizationObjective>(information));
    setup.setPlanner(std::make_shared<og::BITstar>(information));
  } else {
    setup.setPlanner(std::make_shared<og::RRTConnect>(information));
  }
  const auto begin = std::chrono::steady_clock::now();
  if (setup.solve(limit_s) != ob::PlannerStatus::EXACT_SOLUTION) return {};
  const double spent =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (peer == OmplPeer::kRrtConnect && spent < limit_s) setup.simplifySolution(limit_s - spent);
  SpaceLine line;
  for (const ob::State* state : setup.getSolutionPath().getStates()) {
    line.push_back(point_of(state, dimension));
  }
  return line;
}

void seed_ompl(std::uint32_t seed) {
  ompl::RNG::setSeed(seed);
}

}  // namespace swiftlet
