// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/planning/collision_peer.hpp"

#include <fcl/geometry/octree/octree.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>
#include <octomap/octomap.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

namespace swiftlet {
namespace {

using SteadyClock = std::chrono::steady_clock;

double seconds_since(SteadyClock::time_point begin) {
  return std::chrono::duration<double>(SteadyClock::now() - begin).count();
}

std::shared_ptr<octomap::OcTree> octree_of(const VoxelGrid& grid) {
  auto tree = std::make_shared<octomap::OcTree>(1.0);
  for (int z = 0; z < grid.size_z(); ++z) {
    for (int y = 0; y < grid.size_y(); ++y) {
      for (int x = 0; x < grid.size_x(); ++x) {
        if (grid.blocked({x, y, z})) tree->updateNode(x + 0.5, y + 0.5, z + 0.5, true, true);
      }
    }
  }
  tree->updateInnerOccupancy();
  tree->prune();
  return tree;
}

Voxel voxel_of(const Eigen::Vector3d& point) {
  return {static_cast<int>(point.x()), static_cast<int>(point.y()), static_cast<int>(point.z())};
}

/// Of several times that `pass` takes: one is a millisecond, and as much as another process takes
/// away at once.
template <class Pass>
double median_seconds(Pass pass) {
  std::array<double, 9> times{};
  for (double& time : times) {
    const auto begin = SteadyClock::now();
    pass();
    time = seconds_since(begin);
  }
  std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
  return times[times.size() / 2];
}

}  // namespace

CollisionComparison compare_with_fcl(const VoxelGrid& grid, double radius, int checks,
                                     std::uint32_t seed) {
  CollisionComparison result;
  result.checks = checks;
  std::mt19937 random(seed);
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < checks; ++i) {
    const auto along = [&random](int size) {
      return std::min(std::uniform_real_distribution<>(0.0, size)(random), std::nextafter(size, 0));
    };
    places.emplace_back(along(grid.size_x()), along(grid.size_y()), along(grid.size_z()));
  }

  const auto begin = SteadyClock::now();
  const VoxelGrid grown = grid.grown(radius);
  result.prepare_seconds = seconds_since(begin);
  std::vector<char> ours(places.size());
  result.seconds = median_seconds([&] {
    for (std::size_t i = 0; i < places.size(); ++i) ours[i] = grown.blocked(voxel_of(places[i]));
  });

  const fcl::CollisionObjectd map(
      std::make_shared<fcl::OcTreed>(std::shared_ptr<const octomap::OcTree>(octree_of(grid))));
  fcl::CollisionObjectd ball(std::make_shared<fcl::Sphered>(radius));
  const fcl::CollisionRequestd request;
  std::vector<char> peers(places.size());
  result.peer_seconds = median_seconds([&] {
    for (std::size_t i = 0; i < places.size(); ++i) {
      ball.setTranslation(places[i]);
      ball.computeAABB();
      fcl::CollisionResultd answer;
      peers[i] = fcl::collide(&map, &ball, request, answer) > 0;
    }
  });

  for (std::size_t i = 0; i < places.size(); ++i) {
    result.contacts += peers[i];
    result.missed += peers[i] && !ours[i] ? 1 : 0;
    result.needless += ours[i] && !peers[i] ? 1 : 0;
  }
  return result;
}

}  // namespace swiftlet
