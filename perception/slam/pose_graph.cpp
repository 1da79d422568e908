// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/pose_graph.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace swiftlet {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Of Cauchy's loss, in standard deviations. What is off by much more hardly pulls any more, which
// is right for a false closure and wrong for a true one after a long drift. So the loss is wide at
// first, and narrowed as the poses come to agree (graduated non-convexity, Blake and Zisserman).
constexpr double kRobustScale = 2.0;
constexpr double kNarrowing = 4.0;

class RelativePoseCost : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit RelativePoseCost(const PoseConstraint& constraint)
      : relative_(constraint.relative),
        root_(constraint.information.llt().matrixU().toDenseMatrix()) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Vector3d> a(parameters[0]), b(parameters[1]);
    const double c = std::cos(a.z()), s = std::sin(a.z());
    Eigen::Matrix2d to_a;
    to_a << c, s, -s, c;
    const Vector2d d = b.head<2>() - a.head<2>();
    const Vector2d seen = to_a * d;
    Vector3d error;
    error << seen - relative_.position, wrap_angle(b.z() - a.z() - relative_.yaw);
    Eigen::Map<Vector3d> out(residuals);
    out = root_ * error;
    if (jacobians == nullptr) return true;
    using RowMajor3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    if (jacobians[0] != nullptr) {
      Matrix3d J = Matrix3d::Zero();
      J.topLeftCorner<2, 2>() = -to_a;
      J(0, 2) = seen.y();
      J(1, 2) = -seen.x();
      J(2, 2) = -1.0;
      Eigen::Map<RowMajor3d> by_a(jacobians[0]);
      by_a = root_ * J;
    }
    if (jacobians[1] != nullptr) {
      Matrix3d J = Matrix3d::Zero();
      J.topLeftCorner<2, 2>() = to_a;
      J(2, 2) = 1.0;
      Eigen::Map<RowMajor3d> by_b(jacobians[1]);
      by_b = root_ * J;
    }
    return true;
  }

 private:
  Pose2 relative_;
  Matrix3d root_;
};

double* block(std::vector<Vector3d>& blocks, int i) {
  return blocks[static_cast<std::size_t>(i)].data();
}

/// In standard deviations.
double largest_robust_error(std::vector<Vector3d>& blocks,
                            const std::vector<PoseConstraint>& constraints) {
  double largest = 0.0;
  for (const PoseConstraint& c : constraints) {
    if (!c.robust) continue;
    const double* parameters[] = {block(blocks, c.from), block(blocks, c.to)};
    Vector3d error;
    RelativePoseCost(c).Evaluate(parameters, error.data(), nullptr);
    largest = std::max(largest, error.norm());
  }
  return largest;
}

ceres::Solver::Summary solve(std::vector<Vector3d>& blocks,
                             const std::vector<PoseConstraint>& constraints, double robust_scale,
                             int max_iterations) {
  ceres::Problem problem;
  for (const PoseConstraint& c : constraints) {
    problem.AddResidualBlock(new RelativePoseCost(c),
                             c.robust ? new ceres::CauchyLoss(robust_scale) : nullptr,
                             block(blocks, c.from), block(blocks, c.to));
  }
  if (problem.HasParameterBlock(block(blocks, 0))) {
    problem.SetParameterBlockConstant(block(blocks, 0));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // One thread, and the same sums on every machine: CHOLMOD brings threads of its own.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-5;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary;
}

}  // namespace

PoseGraphResult optimize_poses(std::vector<Pose2>& poses,
                               const std::vector<PoseConstraint>& constraints, int max_iterations) {
  PoseGraphResult result;
  if (poses.size() < 2 || constraints.empty()) return result;
  std::vector<Vector3d> blocks;
  blocks.reserve(poses.size());
  for (const Pose2& pose : poses) blocks.push_back(pose.vector());
  double scale = kRobustScale * std::max(1.0, largest_robust_error(blocks, constraints));
  for (bool first = true;; first = false) {
    scale = std::max(kRobustScale, scale / kNarrowing);
    const ceres::Solver::Summary summary = solve(blocks, constraints, scale, max_iterations);
    if (first) result.initial_cost = summary.initial_cost;
    result.final_cost = summary.final_cost;
    result.iterations += static_cast<int>(summary.iterations.size());
    if (scale <= kRobustScale) break;
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i] = {blocks[i].head<2>(), wrap_angle(blocks[i].z())};
  }
  return result;
}

}  // namespace swiftlet
