// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/line_matcher.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace swiftlet {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Surfaces that face away from each other are two sides of a wall.
constexpr double kLeastFacing = 0.5;

}  // namespace

SurfaceIndex::SurfaceIndex(ScanPoints points, double cell_size) : cell_size_(cell_size) {
  points.erase(std::remove_if(points.begin(), points.end(),
                              [](const SurfacePoint& p) { return !p.has_normal(); }),
               points.end());
  if (points.empty()) return;
  Vector2d lower = points.front().position, upper = lower;
  for (const SurfacePoint& p : points) {
    lower = lower.cwiseMin(p.position), upper = upper.cwiseMax(p.position);
  }
  origin_ = lower;
  width_ = static_cast<int>((upper.x() - lower.x()) / cell_size) + 1;
  height_ = static_cast<int>((upper.y() - lower.y()) / cell_size) + 1;
  const auto cell_of = [&](const Vector2d& p) {
    const int x = static_cast<int>((p.x() - origin_.x()) / cell_size_);
    const int y = static_cast<int>((p.y() - origin_.y()) / cell_size_);
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  };
  first_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) + 1, 0);
  for (const SurfacePoint& p : points) ++first_[cell_of(p.position) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  points_.resize(points.size());
  for (const SurfacePoint& p : points) points_[next[cell_of(p.position)]++] = p;
}

const SurfacePoint* SurfaceIndex::nearest(const Vector2d& place, double radius) const {
  const Vector2d cell = (place - origin_) / cell_size_;
  if (!(std::abs(cell.x()) < 1e6 && std::abs(cell.y()) < 1e6)) return nullptr;
  const int cx = static_cast<int>(std::floor(cell.x()));
  const int cy = static_cast<int>(std::floor(cell.y()));
  const SurfacePoint* best = nullptr;
  double least = radius * radius;
  const int from = std::max(0, cx - 1), to = std::min(width_ - 1, cx + 1);
  if (from > to) return nullptr;
  for (int y = std::max(0, cy - 1); y <= std::min(height_ - 1, cy + 1); ++y) {
    // Cells of a row lie one behind the other.
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    const std::uint32_t end = first_[row + static_cast<std::size_t>(to) + 1];
    for (std::uint32_t i = first_[row + static_cast<std::size_t>(from)]; i < end; ++i) {
      const double d = (points_[i].position - place).squaredNorm();
      if (d < least) least = d, best = &points_[i];
    }
  }
  return best;
}

LineMatch match_lines(const SurfaceIndex& map, const ScanPoints& scan, const Pose2& guess,
                      const LineMatchParams& params, const std::optional<PosePrior>& prior) {
  LineMatch match;
  match.pose = guess;
  if (map.empty() || scan.empty()) return match;
  double radius = params.widest_pairs;
  for (; match.iterations < params.max_iterations; ++match.iterations) {
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(match.pose.yaw).toRotationMatrix();
    Matrix3d H = Matrix3d::Zero();
    Vector3d g = Vector3d::Zero();
    int inliers = 0;
    double squares = 0.0;
    for (const SurfacePoint& point : scan) {
      const Vector2d arm = R * point.position;
      const SurfacePoint* partner = map.nearest(match.pose.position + arm, radius);
      if (partner == nullptr) continue;
      if (point.has_normal() && (R * point.normal).dot(partner->normal) < kLeastFacing) continue;
      const Vector2d& n = partner->normal;
      const double r = n.dot(match.pose.position + arm - partner->position);
      const double scaled = r / params.robust_scale;
      const double weight = 1.0 / (1.0 + scaled * scaled);
      const Vector3d J(n.x(), n.y(), n.y() * arm.x() - n.x() * arm.y());
      H += weight * J * J.transpose();
      g += weight * r * J;
      if (std::abs(r) < params.narrowest_pairs) ++inliers, squares += r * r;
    }
    match.information = H;
    match.inliers = inliers / static_cast<double>(scan.size());
    match.rms = inliers > 0 ? std::sqrt(squares / inliers) : 0.0;
    if (prior) {
      Vector3d off;
      off << match.pose.position - prior->pose.position,
          wrap_angle(match.pose.yaw - prior->pose.yaw);
      H += prior->information;
      g += prior->information * off;
    }
    // Along a corridor there is no information: a little of it keeps the guess.
    const Matrix3d damped = H + 1e-3 * Vector3d(1.0, 1.0, 1.0).asDiagonal().toDenseMatrix();
    const Vector3d step = -damped.ldlt().solve(g);
    if (!step.allFinite()) return match;
    match.pose.position += step.head<2>();
    match.pose.yaw = wrap_angle(match.pose.yaw + step.z());
    const bool narrow = radius <= params.narrowest_pairs;
    radius = std::max(params.narrowest_pairs, 0.8 * radius);
    if (narrow && step.norm() < params.converged_below) {
      match.converged = true;
      break;
    }
  }
  return match;
}

LeastKnown least_known(const LineMatch& match) {
  const Eigen::Matrix2d of_position = match.information.topLeftCorner<2, 2>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(of_position);
  return {solver.eigenvectors().col(0), solver.eigenvalues()[0]};
}

Matrix3d information_in(const LineMatch& match, double yaw, const LineMatchNoise& noise) {
  Matrix3d T_map_frame = Matrix3d::Identity();
  T_map_frame.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(yaw).toRotationMatrix();
  return T_map_frame.transpose() * match.information * T_map_frame / noise.variance() +
         Matrix3d::Identity() / (noise.unseen * noise.unseen);
}

}  // namespace swiftlet
