// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "perception/slam/local_map.hpp"
#include "perception/slam/loop_closer.hpp"
#include "perception/slam/motion_model.hpp"
#include "perception/slam/neighbour_aligner.hpp"
#include "perception/slam/pose_graph.hpp"
#include "perception/slam/slam_graph.hpp"

namespace swiftlet {

/// Simultaneous localisation and mapping with a planar scanner, with odometry or without.
///
/// The front end, `add`, matches each scan with the last keyframes around it: a search of all poses
/// that the vehicle may have come to, then an alignment of points to lines. A scan from where the
/// last keyframe does not tell enough becomes a keyframe itself: a node of a graph whose edges are
/// what matches said.
///
/// The back end, `run_back_end`, looks for places that have been seen before, aligns keyframes with
/// those around them, and finds the poses that agree best with all edges. It is a pure function of
/// what it is given, so that it may run beside the front end, in another thread; `apply` takes its
/// result in, at any later time.
///
/// The map frame is odometry's at the first scan, else the first scan's.
class LidarSlam {
 public:
  struct Params {
    int recent_keyframes = 15;        ///< scans are matched with
    double recent_radius = 10.0;      ///< of them, those that near [m]
    double keyframe_distance = 0.25;  ///< from the last one, that makes a new one [m]
    double keyframe_angle = 0.20;     ///< the same [rad]
    double least_overlap = 0.5;       ///< share of points with a partner, below which it is weak
    double weak_score = 0.45;         ///< of the search, below which a weak match is none
    // Without odometry: what the vehicle may have done since the last scan.
    MotionModel::Params motion;
    double max_distance = 6.0;  ///< is searched for, however long it has been [m]
    /// Of the position, in points: where a scan tells less about a direction, the last motion goes
    /// on along it.
    double least_information = 40.0;
    // With odometry: how far off that may be.
    double odometry_distance = 0.02;            ///< at rest [m]
    double odometry_distance_per_metre = 0.05;  ///<
    double odometry_angle = 0.02;               ///< at rest [rad]
    double odometry_angle_per_metre = 0.06;     ///< [rad/m]
    double odometry_angle_per_radian = 0.10;    ///<
    LineMatchNoise noise;
    LoopCloserParams loops;
    NeighbourParams neighbours;
  };

  struct Update {
    Pose2 pose;                                            ///< of the scanner in the map
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, yaw), axes of the map
    bool is_keyframe = false;
    /// The scan could not be matched: the pose is odometry's, or the last one.
    bool lost = false;
    double overlap = 0.0;  ///< share of the scan's points that lie on known surfaces
  };

  LidarSlam() : LidarSlam(Params{}) {}
  explicit LidarSlam(const Params& params) : params_(params), motion_(params.motion) {}

  /// Where a scan was taken. `odometry`: the scanner's pose, as wheels or another estimate have it;
  /// passed over where it is not finite or has jumped.
  Update add(Time time, ScanPoints points, const std::optional<Pose2>& odometry = std::nullopt);

  /// What the back end works on.
  struct BackEndJob {
    std::vector<KeyframePtr> keyframes;
    std::vector<Pose2> poses;  ///< of the keyframes
    std::vector<PoseConstraint> constraints;
    int first_new = 0;  ///< keyframe that no job has had before
    Params params;
  };
  struct BackEndResult {
    std::vector<Pose2> poses;
    std::vector<PoseConstraint> closures;  ///< new ones
    std::vector<PoseConstraint> pairs;     ///< of new keyframes with those around them
    bool optimized = false;
  };
  bool has_job() const { return first_new_ < static_cast<int>(keyframes_.size()); }
  /// The keyframes since the last job. One job at a time.
  BackEndJob take_job();
  static BackEndResult run_back_end(const BackEndJob& job);
  /// Keyframes that have come since the job was taken move along with its last one.
  void apply(const BackEndResult& result);

  /// Goes on in a larger map, of which the last `own` keyframes are the first of this one: what it
  /// has seen since moves along. No job may be under way.
  void enter(const SlamGraph& joined, int own);
  /// Finds itself in a map from now on, and adds nothing to it. `T_map_own`: where the frame is in
  /// which it was until now. No job may be under way, and none comes any more.
  void stay_in(const SlamGraph& map, const Pose2& T_map_own);

  const std::vector<KeyframePtr>& keyframes() const { return keyframes_; }
  /// Of the keyframes, as known now.
  const std::vector<Pose2>& poses() const { return poses_; }
  const std::vector<PoseConstraint>& constraints() const { return constraints_; }

  struct TimedPose {
    Time time{};
    Pose2 pose;
    std::optional<Pose2> odometry;
  };
  /// Of all scans, as known now.
  std::vector<TimedPose> trajectory() const;

 private:
  struct ScanNode {
    Time time{};
    int keyframe = 0;  ///< that it hangs on
    Pose2 relative;    ///< T_keyframe_scan
    std::optional<Pose2> odometry;
  };
  struct Prediction {
    Pose2 pose;
    SearchWindow window;
    std::optional<PosePrior> prior;
    std::optional<Eigen::Matrix2d> covariance;  ///< of the position, where the last motion goes on
    Eigen::Vector3d sigma;                      ///< where nothing better is known
  };
  Prediction predict(Time time, const std::optional<Pose2>& odometry) const;
  std::optional<ScanMatch> match(const Keyframe& scan, const Prediction& prediction);
  ScanMatch going_on(const Keyframe& scan, const ScanMatch& match,
                     const Prediction& prediction) const;
  std::vector<int> keyframes_for(const Eigen::Vector2d& place) const;
  void add_keyframe(Keyframe keyframe, const Pose2& pose);
  Pose2 pose_of(const ScanNode& scan) const {
    return poses_[static_cast<std::size_t>(scan.keyframe)] * scan.relative;
  }

  Params params_;
  bool map_is_fixed_ = false;
  std::vector<KeyframePtr> keyframes_;
  std::vector<Pose2> poses_;
  std::vector<PoseConstraint> constraints_;
  std::vector<ScanNode> scans_;
  MotionModel motion_;
  std::optional<LocalMap> recent_map_;  ///< of `recent_map_of_`, while nothing has moved
  std::vector<int> recent_map_of_;
  int first_new_ = 0;      ///< keyframe that no job has had yet
  int job_keyframes_ = 0;  ///< that the last job had
  Pose2 job_last_pose_;    ///< of its last keyframe, before it ran
};

}  // namespace swiftlet
