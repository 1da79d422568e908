// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/lidar_slam.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace swiftlet {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Searched to either side of what odometry says, in its standard deviations.
constexpr double kSearchSigmas = 4.0;
// What a search around no more than the last pose begins with.
constexpr double kRestDistance = 0.25, kRestAngle = 0.3;  // [m], [rad]
// The poses are brought into agreement when a closure is off by so much, and every so often.
constexpr double kMovedDistance = 0.03, kMovedAngle = 0.01;  // [m], [rad]
constexpr int kManyKeyframes = 50;
constexpr int kIterations = 10;
constexpr double kWeakReach = 6.0;    // of the whole map, when the last keyframes do not help [m]
constexpr double kClearlyMore = 0.1;  // overlap

// Beyond, and beyond what is searched for anyway, odometry has jumped and says nothing [m/s].
constexpr double kFastest = 20.0;

Matrix3d squared(const Vector3d& sigma) {
  return sigma.cwiseAbs2().asDiagonal();
}

}  // namespace

LidarSlam::Prediction LidarSlam::predict(Time time, const std::optional<Pose2>& odometry) const {
  const ScanNode& last = scans_.back();
  const Pose2 last_pose = pose_of(last);
  Prediction prediction;
  const double seconds = std::max(0.0, to_seconds(time - last.time));
  const Pose2 moved = odometry && last.odometry ? last.odometry->inverse() * *odometry : Pose2{};
  const double distance = moved.position.norm(), turned = std::abs(moved.yaw);
  const bool jumped = !(distance < params_.max_distance + kFastest * seconds);
  if (odometry && last.odometry && !jumped) {
    const double sigma_p =
        params_.odometry_distance + params_.odometry_distance_per_metre * distance;
    const double sigma_yaw = params_.odometry_angle + params_.odometry_angle_per_metre * distance +
                             params_.odometry_angle_per_radian * turned;
    prediction.sigma = {sigma_p, sigma_p, sigma_yaw};
    prediction.pose = last_pose * moved;
    prediction.window = {std::min(params_.max_distance, kSearchSigmas * sigma_p),
                         std::min(M_PI, kSearchSigmas * sigma_yaw), 0.2, 0.15, 0.15};
    prediction.prior =
        PosePrior{prediction.pose, params_.noise.variance() * squared(prediction.sigma).inverse()};
    return prediction;
  }
  prediction.pose = last_pose;
  if (const auto motion = motion_.predict(seconds)) {
    prediction.pose = last_pose * motion->relative;
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(last_pose.yaw).toRotationMatrix();
    prediction.covariance = R * motion->covariance.topLeftCorner<2, 2>() * R.transpose();
  }
  const double reach =
      std::min(params_.max_distance, kRestDistance + params_.motion.max_speed * seconds);
  const double angle = std::min(M_PI, kRestAngle + params_.motion.max_yaw_rate * seconds);
  prediction.window = {reach, angle, 0.3, 0.05, 0.05};
  prediction.sigma = {0.5 * reach, 0.5 * reach, 0.5 * angle};
  return prediction;
}

/// The last ones that are near; in a map that stays as it is, all that are near. There the place is
/// taken to the metre, so that they are the same ones for a while.
std::vector<int> LidarSlam::keyframes_for(const Eigen::Vector2d& place) const {
  std::vector<int> which;
  const int count = static_cast<int>(keyframes_.size());
  const int first = map_is_fixed_ ? 0 : std::max(0, count - params_.recent_keyframes);
  const Eigen::Vector2d center = map_is_fixed_ ? place.array().round().matrix() : place;
  for (int i = first; i < count; ++i) {
    const Eigen::Vector2d& position = poses_[static_cast<std::size_t>(i)].position;
    if ((position - center).norm() < params_.recent_radius) which.push_back(i);
  }
  return which;
}

/// Along the direction in which a scan does not tell the place, and along no other, the last motion
/// goes on (Zhang, Kaess and Singh, On Degeneracy of Optimization-based State Estimation Problems,
/// 2016).
ScanMatch LidarSlam::going_on(const Keyframe& scan, const ScanMatch& match,
                              const Prediction& prediction) const {
  const LeastKnown least = least_known(match.fine);
  if (!prediction.covariance || least.information >= params_.least_information) return match;
  const Vector2d& e = least.direction;
  PosePrior prior{prediction.pose, Matrix3d::Zero()};
  prior.information.topLeftCorner<2, 2>() =
      params_.noise.variance() / e.dot(*prediction.covariance * e) * e * e.transpose();
  Pose2 guess = match.pose();
  guess.position += e * e.dot(prediction.pose.position - guess.position);
  const LineMatch held = recent_map_->align(scan, guess, prior);
  // Where it then fits worse, the scan did tell, and the vehicle did not go on.
  return held.inliers < match.fine.inliers - kClearlyMore ? match : ScanMatch{match.score, held};
}

/// With the last keyframes, or, where those do not help, with all that is near.
std::optional<ScanMatch> LidarSlam::match(const Keyframe& scan, const Prediction& prediction) {
  const std::vector<int> recent = keyframes_for(prediction.pose.position);
  if (!recent_map_ || recent != recent_map_of_) {
    recent_map_.emplace(keyframes_, poses_, recent);
    recent_map_of_ = recent;
  }
  auto match = recent_map_->match(scan, prediction.pose, prediction.window, prediction.prior);
  if (match) match = going_on(scan, *match, prediction);
  if (match && match->fine.inliers >= params_.least_overlap) return match;

  std::vector<int> near;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const double distance = (poses_[i].position - prediction.pose.position).norm();
    if (distance < prediction.window.distance + kWeakReach) near.push_back(static_cast<int>(i));
  }
  SearchWindow wide = prediction.window;
  wide.distance = std::min(params_.max_distance, 2.0 * wide.distance + 0.5);
  wide.angle = std::min(M_PI, 2.0 * wide.angle);
  wide.least_score = params_.weak_score;
  const auto again = LocalMap(keyframes_, poses_, near).match(scan, prediction.pose, wide);
  if (again && (!match || again->fine.inliers > match->fine.inliers + kClearlyMore)) match = again;
  // Odometry and a little of the scan are better than odometry; a little of the scan alone is not.
  const bool weak = match && match->fine.inliers < params_.least_overlap;
  if (weak && !prediction.prior && match->score < params_.weak_score) return std::nullopt;
  return match;
}

LidarSlam::Update LidarSlam::add(Time time, ScanPoints points,
                                 const std::optional<Pose2>& given_odometry) {
  Update update;
  std::optional<Pose2> odometry = given_odometry;
  if (odometry && !odometry->vector().allFinite()) odometry.reset();
  Keyframe scan = make_keyframe(time, std::move(points), odometry);
  if (keyframes_.empty()) {
    update.pose = odometry.value_or(Pose2{});
    add_keyframe(std::move(scan), update.pose);
    scans_.push_back({time, 0, Pose2{}, odometry});
    update.is_keyframe = true;
    update.overlap = 1.0;
    return update;
  }
  const Prediction prediction = predict(time, odometry);
  const auto found = match(scan, prediction);
  const int last = map_is_fixed_ ? scans_.back().keyframe : static_cast<int>(keyframes_.size()) - 1;
  const Pose2 last_pose = poses_[static_cast<std::size_t>(last)];
  PoseConstraint edge{last, last + 1, Pose2{}, Matrix3d::Zero(), false};
  if (found) {
    update.pose = found->pose();
    update.overlap = found->fine.inliers;
    update.covariance = information_in(found->fine, 0.0, params_.noise).inverse();
    edge.information = information_in(found->fine, last_pose.yaw, params_.noise);
  } else {
    update.pose = prediction.pose;
    update.lost = true;
    update.covariance = squared(prediction.sigma);
    edge.information = squared(prediction.sigma).inverse();
  }
  const ScanNode& before = scans_.back();
  const Pose2 pose_before = pose_of(before);
  motion_.update(
      to_seconds(time - before.time), pose_before.inverse() * update.pose,
      found ? information_in(found->fine, pose_before.yaw, params_.noise) : Matrix3d::Zero());
  edge.relative = last_pose.inverse() * update.pose;
  update.is_keyframe =
      !map_is_fixed_ && (update.overlap < 1.2 * params_.least_overlap ||
                         edge.relative.position.norm() > params_.keyframe_distance ||
                         std::abs(edge.relative.yaw) > params_.keyframe_angle);
  if (!update.is_keyframe) {
    scans_.push_back({time, last, edge.relative, odometry});
    return update;
  }
  constraints_.push_back(edge);
  add_keyframe(std::move(scan), update.pose);
  scans_.push_back({time, last + 1, Pose2{}, odometry});
  return update;
}

void LidarSlam::add_keyframe(Keyframe keyframe, const Pose2& pose) {
  keyframes_.push_back(std::make_shared<const Keyframe>(std::move(keyframe)));
  poses_.push_back(pose);
}

LidarSlam::BackEndJob LidarSlam::take_job() {
  BackEndJob job{keyframes_, poses_, constraints_, first_new_, params_};
  first_new_ = job_keyframes_ = static_cast<int>(keyframes_.size());
  job_last_pose_ = poses_.back();
  return job;
}

LidarSlam::BackEndResult LidarSlam::run_back_end(const BackEndJob& job) {
  BackEndResult result;
  result.poses = job.poses;
  bool moved = false;
  for (int i = job.first_new; i < static_cast<int>(job.keyframes.size()); ++i) {
    for (const PoseConstraint& closure :
         close_loops(job.keyframes, result.poses, i, job.params.loops, job.params.noise)) {
      const Pose2 found = result.poses[static_cast<std::size_t>(closure.from)] * closure.relative;
      const Pose2 off = result.poses[static_cast<std::size_t>(i)].inverse() * found;
      moved |= off.position.norm() > kMovedDistance || std::abs(off.yaw) > kMovedAngle;
      result.closures.push_back(closure);
    }
  }
  for (int i = job.first_new; i < static_cast<int>(job.keyframes.size()); ++i) {
    const auto pairs = align_with_neighbours(job.keyframes, result.poses, i, job.params.neighbours,
                                             job.params.noise);
    result.pairs.insert(result.pairs.end(), pairs.begin(), pairs.end());
  }
  moved |= static_cast<int>(job.keyframes.size()) / kManyKeyframes > job.first_new / kManyKeyframes;
  if (!moved) return result;
  std::vector<PoseConstraint> all = job.constraints;
  all.insert(all.end(), result.closures.begin(), result.closures.end());
  all.insert(all.end(), result.pairs.begin(), result.pairs.end());
  optimize_poses(result.poses, all, kIterations);
  result.optimized = true;
  return result;
}

void LidarSlam::apply(const BackEndResult& result) {
  constraints_.insert(constraints_.end(), result.closures.begin(), result.closures.end());
  constraints_.insert(constraints_.end(), result.pairs.begin(), result.pairs.end());
  if (!result.optimized) return;
  const Pose2 correction = result.poses.back() * job_last_pose_.inverse();
  std::copy(result.poses.begin(), result.poses.end(), poses_.begin());
  for (std::size_t i = static_cast<std::size_t>(job_keyframes_); i < poses_.size(); ++i) {
    poses_[i] = correction * poses_[i];
  }
  recent_map_.reset();
}

void LidarSlam::enter(const SlamGraph& joined, int own) {
  const int offset = joined.size() - own;
  const Pose2 correction =
      joined.poses.back() * poses_[static_cast<std::size_t>(own - 1)].inverse();
  std::vector<KeyframePtr> keyframes = joined.keyframes;
  std::vector<Pose2> poses = joined.poses;
  for (std::size_t i = static_cast<std::size_t>(own); i < keyframes_.size(); ++i) {
    keyframes.push_back(keyframes_[i]);
    poses.push_back(correction * poses_[i]);
  }
  std::vector<PoseConstraint> constraints = joined.constraints;
  for (PoseConstraint constraint : constraints_) {
    if (std::max(constraint.from, constraint.to) < own) continue;
    constraint.from += offset;
    constraint.to += offset;
    constraints.push_back(constraint);
  }
  keyframes_ = std::move(keyframes);
  poses_ = std::move(poses);
  constraints_ = std::move(constraints);
  for (ScanNode& scan : scans_) scan.keyframe += offset;
  first_new_ += offset;
  recent_map_.reset();
}

void LidarSlam::stay_in(const SlamGraph& map, const Pose2& T_map_own) {
  const Pose2 to_first = map.poses.front().inverse() * T_map_own;
  for (ScanNode& scan : scans_) scan = {scan.time, 0, to_first * pose_of(scan), scan.odometry};
  keyframes_ = map.keyframes;
  poses_ = map.poses;
  constraints_ = map.constraints;
  first_new_ = map.size();
  map_is_fixed_ = true;
  recent_map_.reset();
}

std::vector<LidarSlam::TimedPose> LidarSlam::trajectory() const {
  std::vector<TimedPose> trajectory;
  trajectory.reserve(scans_.size());
  for (const ScanNode& scan : scans_) {
    trajectory.push_back({scan.time, pose_of(scan), scan.odometry});
  }
  return trajectory;
}

}  // namespace swiftlet
