// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

namespace swiftlet {

/// How far positions are from a reference whose samples come at other times: the reference is
/// interpolated linearly at the time of each position.
class PathError {
 public:
  struct At {
    double time = 0.0;                                ///< of the position [s]
    Eigen::Vector3d error = Eigen::Vector3d::Zero();  ///< position - reference [m]
  };
  using OnError = std::function<void(const At&)>;

  /// Between samples of the reference that are more than `longest_gap` [s] apart there is none.
  PathError(double longest_gap, OnError on_error)
      : longest_gap_(longest_gap), on_error_(std::move(on_error)) {}

  /// Both in the order of time; what is not finite is none.
  void add_position(double time, const Eigen::Vector3d& position);
  void add_reference(double time, const Eigen::Vector3d& reference);
  /// There is no reference until the next one.
  void end_reference();

  std::uint64_t count() const { return count_; }
  /// Root of the mean of the squares, by axis [m]; nothing without an error.
  std::optional<Eigen::Vector3d> rms() const;
  /// Of the length of the error [m].
  double largest() const { return largest_; }

 private:
  struct Sample {
    double time;
    Eigen::Vector3d position;
  };
  void note(const At& at);

  double longest_gap_;
  OnError on_error_;
  std::deque<Sample> waiting_;  // for a reference that is as late
  std::optional<Sample> reference_;
  std::uint64_t count_ = 0;
  Eigen::Vector3d squares_ = Eigen::Vector3d::Zero();
  double largest_ = 0.0;
};

/// A point of a track on the map.
struct TrackPoint {
  double time = 0.0;  ///< since the beginning of the recording [s]
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
};

/// The way of the vehicle, in steps: a point counts when it is a step away from the last, so that
/// the noise of a vehicle that hovers adds nothing to its length. Of a long way the drawn steps get
/// longer, at most kMostPoints stay; its length does not change by that.
class Track {
 public:
  static constexpr double kStep = 0.05;  ///< [m]
  static constexpr std::size_t kMostPoints = 4000;

  void add(double time, const Eigen::Vector3d& position);
  double length() const { return length_; }  ///< in space [m]
  const std::vector<TrackPoint>& points() const { return points_; }

 private:
  std::optional<Eigen::Vector3d> last_;
  double length_ = 0.0;
  std::uint64_t steps_ = 0;
  std::uint64_t keep_every_ = 1;
  std::vector<TrackPoint> points_;
};

}  // namespace swiftlet
