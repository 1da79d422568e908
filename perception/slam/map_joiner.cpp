// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/map_joiner.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace swiftlet {
namespace {

using Eigen::Vector2d;

LocalMap whole_of(const SlamGraph& graph) {
  std::vector<int> all(graph.keyframes.size());
  std::iota(all.begin(), all.end(), 0);
  return LocalMap(graph.keyframes, graph.poses, all);
}

/// What was seen around a keyframe, as if all of it had been seen from there.
Keyframe patch_around(const SlamGraph& graph, int center, const FrameSearchParams& params) {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  const Pose2 to_center = graph.poses[at(center)].inverse();
  ScanPoints points;
  const int last = std::min(graph.size() - 1, center + params.patch);
  for (int i = std::max(0, center - params.patch); i <= last; ++i) {
    const Pose2 moved = to_center * graph.poses[at(i)];
    if (moved.position.norm() > params.patch_radius) continue;
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(moved.yaw).toRotationMatrix();
    for (const SurfacePoint& point : graph.keyframes[at(i)]->points) {
      points.push_back({moved.position + R * point.position, R * point.normal});
    }
  }
  return make_keyframe(graph.keyframes[at(center)]->time, std::move(points), std::nullopt);
}

/// The middle of what a map knows, and how far from it that goes.
struct Extent {
  Vector2d middle = Vector2d::Zero();
  double reach = 0.0;  // to either side [m]
};
Extent extent_of(const SlamGraph& graph) {
  Vector2d lower = graph.poses.front().position, upper = lower;
  for (const Pose2& pose : graph.poses) {
    lower = lower.cwiseMin(pose.position);
    upper = upper.cwiseMax(pose.position);
  }
  constexpr double kBeyond = 2.0;  // the way of the first; the other may have been there [m]
  return {0.5 * (lower + upper), 0.5 * (upper - lower).maxCoeff() + kBeyond};
}

struct Vote {
  Pose2 frame;  // T_map_other
  double inliers = 0.0;
};

/// What one place of the other says; nothing where it is not found.
std::optional<Vote> ask(const LocalMap& map, const SlamGraph& other, int place, const Pose2& guess,
                        const SearchWindow& window, const FrameSearchParams& params) {
  const auto match = map.match(patch_around(other, place, params), guess, window);
  if (!match || match->fine.inliers < params.least_inliers) return std::nullopt;
  const Pose2& of_place = other.poses[static_cast<std::size_t>(place)];
  return Vote{match->pose() * of_place.inverse(), match->fine.inliers};
}

bool agree(const Pose2& a, const Pose2& b, const SlamGraph& other,
           const FrameSearchParams& params) {
  // Where the other was, not at its origin, which may be far away.
  const Pose2& somewhere = other.poses[other.poses.size() / 2];
  const Pose2 off = (a * somewhere).inverse() * (b * somewhere);
  return off.position.norm() < params.agree_distance && std::abs(off.yaw) < params.agree_angle;
}

/// Adds the constraints that `find` has for each keyframe from `offset` on, put behind those
/// before.
template <class Find>
void each_beside_map(SlamGraph& joined, int offset, Find find) {
  const auto begin = static_cast<std::ptrdiff_t>(offset);
  std::vector<KeyframePtr> keyframes(joined.keyframes.begin(), joined.keyframes.begin() + begin);
  std::vector<Pose2> poses(joined.poses.begin(), joined.poses.begin() + begin);
  keyframes.emplace_back();
  poses.emplace_back();
  for (int i = offset; i < joined.size(); ++i) {
    keyframes.back() = joined.keyframes[static_cast<std::size_t>(i)];
    poses.back() = joined.poses[static_cast<std::size_t>(i)];
    for (PoseConstraint constraint : find(keyframes, poses)) {
      (constraint.from == offset ? constraint.from : constraint.to) = i;
      joined.constraints.push_back(constraint);
    }
  }
}

}  // namespace

std::optional<Pose2> find_frame(const SlamGraph& map, const SlamGraph& other,
                                const FrameSearchParams& params) {
  if (map.size() == 0 || other.size() == 0) return std::nullopt;
  const LocalMap whole = whole_of(map);
  const Extent extent = extent_of(map);
  SearchWindow window;
  window.distance = extent.reach;
  window.angle = M_PI;
  window.least_score = params.least_score;
  window.distance_penalty = window.angle_penalty = 0.0;
  std::vector<Vote> votes;
  const int places = std::min(params.places, other.size());
  for (int i = 0; i < places; ++i) {
    const int place = places > 1 ? i * (other.size() - 1) / (places - 1) : 0;
    if (const auto vote = ask(whole, other, place, {extent.middle, 0.0}, window, params)) {
      votes.push_back(*vote);
    }
  }
  const auto supporters = [&](const Pose2& frame) {
    return std::count_if(votes.begin(), votes.end(),
                         [&](const Vote& vote) { return agree(frame, vote.frame, other, params); });
  };
  const Vote* best = nullptr;
  std::ptrdiff_t most = 0;
  for (const Vote& vote : votes) {
    const auto count = supporters(vote.frame);
    if (count > most || (count == most && best != nullptr && vote.inliers > best->inliers)) {
      most = count;
      best = &vote;
    }
  }
  if (most < params.least_votes) return std::nullopt;
  for (const Vote& vote : votes) {
    if (agree(best->frame, vote.frame, other, params)) continue;
    const auto against = static_cast<double>(supporters(vote.frame));
    if (static_cast<double>(most) < params.clear_majority * against) return std::nullopt;
  }
  return best->frame;
}

std::optional<Pose2> refine_frame(const SlamGraph& map, const SlamGraph& other, const Pose2& guess,
                                  double distance, double angle, const FrameSearchParams& params) {
  if (map.size() == 0 || other.size() == 0) return std::nullopt;
  SearchWindow window;
  window.distance = distance;
  window.angle = angle;
  window.least_score = params.least_score;
  const int place = other.size() - 1;
  const Pose2 there = guess * other.poses.back();
  const auto vote = ask(whole_of(map), other, place, there, window, params);
  if (!vote) return std::nullopt;
  return vote->frame;
}

SlamGraph join_maps(const SlamGraph& map, const SlamGraph& other, const Pose2& T_map_other,
                    const JoinParams& params) {
  SlamGraph joined = map;
  const int offset = map.size();
  joined.keyframes.insert(joined.keyframes.end(), other.keyframes.begin(), other.keyframes.end());
  for (const Pose2& pose : other.poses) joined.poses.push_back(T_map_other * pose);
  for (PoseConstraint constraint : other.constraints) {
    constraint.from += offset;
    constraint.to += offset;
    joined.constraints.push_back(constraint);
  }
  // Only with the map: what the other knows of itself, it has said. Once both agree to a few
  // centimetres, each keyframe is aligned with those around it, too.
  LoopCloserParams loops = params.loops;
  loops.recent = 1;
  each_beside_map(joined, offset, [&](const auto& keyframes, const auto& poses) {
    return close_loops(keyframes, poses, offset, loops, params.noise);
  });
  optimize_poses(joined.poses, joined.constraints, params.iterations);
  each_beside_map(joined, offset, [&](const auto& keyframes, const auto& poses) {
    return align_with_neighbours(keyframes, poses, offset, params.neighbours, params.noise);
  });
  optimize_poses(joined.poses, joined.constraints, params.iterations);
  return joined;
}

}  // namespace swiftlet
