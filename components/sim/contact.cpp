// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace swiftlet {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// A vehicle whose feet are less than this above the ground is standing, landing or bouncing.
constexpr double kFlyingHeight = 0.05;
constexpr std::size_t kCollisionsKept = 1000;
// A hull that bounces along a wall collides once until it has been clear of it by this much.
constexpr double kReleaseDistance = 0.01;
// Below this sliding speed the friction of the hull fades out, so that it never reverses motion.
constexpr double kSlidingSpeed = 0.05;

Vector3d velocity_of(const RigidBodyState& body, const Vector3d& arm_W) {
  return body.v_WB_W + (body.q_WB * body.w_WB_B).cross(arm_W);
}

}  // namespace

GroundContact::GroundContact(const Params& params, const QuadrotorModel& model) : params_(params) {
  const double foot = params.leg_spread * std::sqrt(0.5);
  for (const double x : {foot, -foot}) {
    for (const double y : {foot, -foot}) points_.push_back({Vector3d(x, y, -params.leg_height)});
  }
  for (const Vector2d& hub : {Vector2d(1, 0), Vector2d(0, -1), Vector2d(-1, 0), Vector2d(0, 1)}) {
    points_.push_back({Vector3d(model.arm_length * hub.x(), model.arm_length * hub.y(), 0.02)});
  }
  points_.push_back({Vector3d(0.0, 0.0, params.mast_height)});
  reach_ = 0.0;
  for (const Point& point : points_) reach_ = std::max(reach_, point.p_BP.norm());

  // Four points carry the mass; two pairs of them, at their furthest, turn the lightest axis.
  const double omega2 = params.natural_frequency * params.natural_frequency;
  const double for_mass = model.mass * omega2 / 4.0;
  const double for_turning = model.inertia.minCoeff() * omega2 / (2.0 * reach_ * reach_);
  stiffness_ = std::min(for_mass, for_turning);
  damping_ = 2.0 * params.damping_ratio * stiffness_ / params.natural_frequency;
}

void GroundContact::reset() {
  for (Point& point : points_) point.bristle.setZero();
}

ContactWrench GroundContact::step(const RigidBodyState& body, const World& world, double dt) {
  ContactWrench wrench;
  const auto around = world.nearest(body.p_WB, reach_, World::Surfaces::kGround);
  if (!around) {
    reset();
    return wrench;
  }
  wrench.is_near = around->distance < params_.leg_height + kFlyingHeight;
  for (Point& point : points_) {
    const Vector3d arm_W = body.q_WB * point.p_BP;
    const auto ground = world.nearest(body.p_WB + arm_W, 0.0, World::Surfaces::kGround);
    if (!ground || ground->distance >= 0.0) {
      point.bristle.setZero();
      continue;
    }
    const Vector3d& n = ground->normal;
    const Vector3d velocity = velocity_of(body, arm_W);
    const double normal_speed = velocity.dot(n);
    const double normal_force =
        std::max(0.0, -stiffness_ * ground->distance - damping_ * normal_speed);
    // Spring and damper along the ground, cut at Coulomb's limit; a bristle at its limit slips.
    const Vector3d sliding = velocity - normal_speed * n;
    point.bristle += dt * sliding;
    point.bristle -= point.bristle.dot(n) * n;
    Vector3d friction = -stiffness_ * point.bristle - damping_ * sliding;
    const double limit = params_.friction * normal_force;
    if (friction.norm() > limit) {
      friction *= limit / friction.norm();
      const double longest = limit / stiffness_;
      if (point.bristle.norm() > longest) point.bristle *= longest / point.bristle.norm();
    }
    const Vector3d force = normal_force * n + friction;
    wrench.force_W += force;
    wrench.moment_B += point.p_BP.cross(body.q_WB.conjugate() * force);
    wrench.touches = true;
  }
  return wrench;
}

HullContact::HullContact(const Params& params, const QuadrotorModel& model)
    : params_(params), mass_(model.mass), min_clearance_(std::numeric_limits<double>::infinity()) {}

ContactWrench HullContact::step(Time now, const RigidBodyState& body, const World& world) {
  // How far away something may be and still matter now: for a collision, or for a new smallest
  // clearance. Where the last query bounds the distance above that, it stands.
  constexpr double kHorizon = 1e3;
  double matters = params_.radius + kReleaseDistance;
  if (watches_clearance_) {
    matters = std::clamp(min_clearance_ + params_.radius, matters, kHorizon);
  }
  const double moved = (body.p_WB - last_query_).norm();
  if (last_revision_ == world.revision() && last_distance_ - moved > matters) return {};

  // Looking twice as far as what matters lets the answer stand for a while.
  const double reach = 2.0 * matters;
  const auto nearest = world.nearest(body.p_WB, reach, World::Surfaces::kObstacles);
  last_query_ = body.p_WB;
  last_revision_ = world.revision();
  last_distance_ = nearest ? nearest->distance : reach;
  if (!nearest) return {};

  const double clearance = nearest->distance - params_.radius;
  if (watches_clearance_) min_clearance_ = std::min(min_clearance_, clearance);
  if (clearance > kReleaseDistance) touched_.clear();
  if (clearance >= 0.0) return {};

  const Vector3d& n = nearest->normal;
  const Vector3d arm_W = -params_.radius * n;
  const Vector3d velocity = velocity_of(body, arm_W);
  const double normal_speed = velocity.dot(n);
  note(now, *nearest, -normal_speed);

  const double stiffness = mass_ * params_.natural_frequency * params_.natural_frequency;
  const double damping = 2.0 * params_.damping_ratio * mass_ * params_.natural_frequency;
  const double normal_force = std::max(0.0, -stiffness * clearance - damping * normal_speed);
  const Vector3d sliding = velocity - normal_speed * n;
  const Vector3d friction =
      -params_.friction * normal_force / std::max(sliding.norm(), kSlidingSpeed) * sliding;
  ContactWrench wrench;
  wrench.touches = true;
  wrench.force_W = normal_force * n + friction;
  wrench.moment_B = body.q_WB.conjugate() * arm_W.cross(wrench.force_W);
  return wrench;
}

void HullContact::note(Time now, const World::Nearest& nearest, double speed) {
  if (touched_ == nearest.model) return;
  touched_ = nearest.model;
  ++count_;
  if (collisions_.size() < kCollisionsKept) {
    collisions_.push_back({now, touched_, nearest.point, std::max(speed, 0.0)});
  }
}

}  // namespace swiftlet
