// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "estimation/basics/time.hpp"
#include "perception/slam/correlative_matcher.hpp"
#include "perception/slam/line_matcher.hpp"

namespace swiftlet {

/// A scan that the map is made of.
struct Keyframe {
  Time time{};
  ScanPoints points;                    ///< in the scanner's levelled frame [m]
  std::vector<Eigen::Vector2d> sparse;  ///< some of them, for searching
  std::optional<Pose2> odometry;        ///< of the scanner, in a frame that drifts
};
using KeyframePtr = std::shared_ptr<const Keyframe>;

Keyframe make_keyframe(Time time, ScanPoints points, const std::optional<Pose2>& odometry);

/// All that these keyframes have seen, in the map.
ScanPoints surfaces_of(const std::vector<KeyframePtr>& keyframes, const std::vector<Pose2>& poses,
                       const std::vector<int>& which);

/// Where a scan is in a map.
struct ScanMatch {
  double score = 0.0;  ///< of the search, 0 to 1
  LineMatch fine;
  const Pose2& pose() const { return fine.pose; }
};

/// Some keyframes at their poses, made ready to match scans with.
class LocalMap {
 public:
  LocalMap(const std::vector<KeyframePtr>& keyframes, const std::vector<Pose2>& poses,
           const std::vector<int>& which);

  /// Searches the whole window around `guess`, then aligns. Nothing where no place in the window
  /// looks like the scan.
  std::optional<ScanMatch> match(const Keyframe& scan, const Pose2& guess,
                                 const SearchWindow& window,
                                 const std::optional<PosePrior>& prior = std::nullopt) const;

  /// Aligns from a guess that is near already.
  LineMatch align(const Keyframe& scan, const Pose2& guess,
                  const std::optional<PosePrior>& prior) const {
    return match_lines(surfaces_, scan.points, guess, {}, prior);
  }

 private:
  explicit LocalMap(ScanPoints points);
  LikelihoodField field_;
  SurfaceIndex surfaces_;
};

}  // namespace swiftlet
