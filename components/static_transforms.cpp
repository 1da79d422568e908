// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/static_transforms.hpp"

#include <cmath>

#include "components/conversions.hpp"

namespace swiftlet {
namespace {

constexpr std::size_t kMostFrames = 1000;
/// Rounded in single precision, a unit quaternion is still nearer to one than this.
constexpr double kNotUnit = 0.01;

}  // namespace

geometry_msgs::msg::TransformStamped to_transform(Time time, const std::string& parent,
                                                  const std::string& child,
                                                  const PoseHistory::Pose& pose) {
  geometry_msgs::msg::TransformStamped transform;
  transform.header(make_header(time, parent));
  transform.child_frame_id(child);
  transform.transform().translation(to_vector3(pose.position));
  transform.transform().rotation(to_msg(pose.attitude));
  return transform;
}

Status StaticTransforms::add(const geometry_msgs::msg::TransformStamped& transform) {
  const std::string& child = transform.child_frame_id();
  Pose pose{from_msg(transform.transform().translation()),
            from_msg(transform.transform().rotation())};
  const bool is_pose = pose.position.allFinite() && std::abs(pose.attitude.norm() - 1.0) < kNotUnit;
  if (!is_pose) return Error{"the transform of '" + child + "' is no position and rotation"};
  if (links_.size() >= kMostFrames && links_.count(child) == 0) {
    return Error{"'" + child + "' is one frame too many"};
  }
  pose.attitude.normalize();
  links_[child] = {transform.header().frame_id(), pose};
  return {};
}

std::optional<StaticTransforms::Pose> StaticTransforms::find(const std::string& root,
                                                             const std::string& frame) const {
  Pose pose;  // of `frame` in `at`
  std::string at = frame;
  // A chain is no longer than there are links; a ring would be.
  for (std::size_t i = 0; i <= links_.size(); ++i) {
    if (at == root) return pose;
    const auto link = links_.find(at);
    if (link == links_.end()) return std::nullopt;
    const Pose& step = link->second.pose;
    pose = {step.position + step.attitude * pose.position, step.attitude * pose.attitude};
    at = link->second.parent;
  }
  return std::nullopt;
}

}  // namespace swiftlet
