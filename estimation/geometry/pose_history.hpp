// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <optional>

#include "estimation/basics/time.hpp"

namespace swiftlet {

/// The last poses of a moving frame, and those between them.
class PoseHistory {
 public:
  struct Pose {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< [m]
    Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< unit
  };

  /// Forgets what is older than `length`.
  explicit PoseHistory(Duration length) : length_(length) {}

  /// Poses come in the order of time; one that is not newer than the last is ignored.
  void add(Time time, const Pose& pose);
  /// Linear in position, spherical linear in attitude. Nothing before the first, after the last,
  /// and in a gap longer than `max_gap`.
  std::optional<Pose> at(Time time, Duration max_gap = Duration::max()) const;

  bool empty() const { return poses_.empty(); }
  /// Only where it is not empty.
  Time oldest() const { return poses_.front().time; }
  Time newest() const { return poses_.back().time; }

 private:
  struct Entry {
    Time time;
    Pose pose;
  };
  Duration length_;
  std::deque<Entry> poses_;
};

}  // namespace swiftlet
