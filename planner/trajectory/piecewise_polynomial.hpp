// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "estimation/basics/time.hpp"
#include "estimation/geometry/rigid_body.hpp"
#include "planner/trajectory/bernstein.hpp"

namespace swiftlet {

/// A polynomial of degree at most 9 in the normalised time s in [0, 1] of its segment:
/// p(s) = c[0] + c[1] s + ... + c[9] s^9.
inline constexpr int kCoefficients = 10;
using Polynomial = Coefficients<kCoefficients>;
/// The square of such a polynomial, or the squared norm of a vector of them.
using SquarePolynomial = Coefficients<2 * kCoefficients - 1>;

/// Axes of a segment's coefficients.
enum Axis : int { kX = 0, kY = 1, kZ = 2, kYaw = 3 };

/// One piece of a trajectory.
struct TrajectorySegment {
  double duration_s = 0.0;
  /// x, y, z [m] and yaw [rad], in the normalised time of the segment.
  std::array<Polynomial, 4> coefficients = {Polynomial::Zero(), Polynomial::Zero(),
                                            Polynomial::Zero(), Polynomial::Zero()};
};

/// A piecewise polynomial of position and yaw, from a start time on.
class Trajectory {
 public:
  Trajectory() = default;
  /// Every duration must be finite and positive, every coefficient finite; otherwise the trajectory
  /// is empty.
  Trajectory(Time start, std::vector<TrajectorySegment> segments);

  bool empty() const { return segments_.empty(); }
  Time start() const { return start_; }
  Time end() const { return start_ + duration(); }
  Duration duration() const { return duration_; }
  const std::vector<TrajectorySegment>& segments() const { return segments_; }

  /// The reference at a time. Before the start and after the end, the first or last position and
  /// yaw with zero derivatives. All zero for an empty trajectory.
  FlatReference evaluate(Time time) const;
  /// Where it ends.
  FlatReference final_reference() const { return evaluate(end() + Duration(1)); }

  /// Upper bounds, true at every moment of the trajectory and at most 1e-6 (relative) above a value
  /// that is taken: from the Bernstein form of the polynomials, not from samples.
  double max_speed() const;         ///< [m/s]
  double max_acceleration() const;  ///< [m/s^2]

 private:
  Time start_{};
  Duration duration_{};
  std::vector<TrajectorySegment> segments_;
};

/// One second of standing still at a reference's position and yaw, up to `end`.
Trajectory resting_at(const FlatReference& reference, Time end);

/// The same bounds for one segment: of the norm of the `order`-th derivative of the position, order
/// 1 to 4.
double max_derivative_norm(const TrajectorySegment& segment, int order);

/// Value of the `order`-th derivative with respect to time [1/s^order] of a segment's axis at the
/// normalised time s.
double derivative(const TrajectorySegment& segment, int axis, double s, int order);

}  // namespace swiftlet
