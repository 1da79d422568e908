// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

namespace swiftlet {

/// A place on Earth (WGS84).
struct GlobalPosition {
  double latitude = 0.0;   ///< [deg]
  double longitude = 0.0;  ///< [deg]
  double altitude = 0.0;   ///< above the ellipsoid [m]

  /// On Earth, and no farther from it than aircraft fly.
  bool usable() const;
};

/// Where the map's origin is on Earth. The map is ENU in the tangent plane there.
class LocalOrigin {
 public:
  explicit LocalOrigin(const GlobalPosition& origin) : origin_(origin) {}

  Eigen::Vector3d to_map(const GlobalPosition& place) const;  ///< [m]
  GlobalPosition to_global(const Eigen::Vector3d& p_W) const;
  const GlobalPosition& position() const { return origin_; }

 private:
  GlobalPosition origin_;
};

/// The origin of a map whose frame was chosen without knowing it: from fixes of a satellite
/// receiver, and where the vehicle was in the map when it had them. The last fixes count most,
/// since the map may drift.
class OriginEstimate {
 public:
  struct Params {
    double memory = 100.0;    ///< fixes that count
    double good_sigma = 1.0;  ///< the origin is to be known to, before it is told [m]
  };
  explicit OriginEstimate(const Params& params) : params_(params) {}
  OriginEstimate() : OriginEstimate(Params{}) {}

  /// A fix with the standard deviation of its position on the plane [m], at `p_WB` in the map. What
  /// is no number and no place on Earth is ignored.
  void add(const GlobalPosition& fix, double sigma, const Eigen::Vector3d& p_WB);

  /// Standard deviation of the origin, were the errors of fixes independent [m]; infinite before
  /// the first.
  double sigma() const;
  /// Nothing while it is not known well.
  std::optional<LocalOrigin> origin() const;

 private:
  Params params_;
  std::optional<LocalOrigin> first_;                // tangent plane to average in
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();  // of the map's origin, in that plane [m]
  double information_ = 0.0;                        // [1/m^2]
};

}  // namespace swiftlet
