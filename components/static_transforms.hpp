// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>

#include "estimation/basics/result.hpp"
#include "estimation/geometry/pose_history.hpp"
#include "geometry_msgs.h"

namespace swiftlet {

/// Pose of frame `child` in `parent`, as tf and tf_static carry it.
geometry_msgs::msg::TransformStamped to_transform(Time time, const std::string& parent,
                                                  const std::string& child,
                                                  const PoseHistory::Pose& pose);

/// Where frames sit on each other for good, as tf_static tells it piece by piece.
class StaticTransforms {
 public:
  using Pose = PoseHistory::Pose;

  /// A frame has one parent: a later transform of the same child replaces the earlier one. Refused:
  /// what is no number or no rotation, and more than a thousand frames.
  Status add(const geometry_msgs::msg::TransformStamped& transform);

  /// Pose of `frame` in `root`, over frames between them if need be; nothing where it is not known.
  /// A frame in itself needs no transform.
  std::optional<Pose> find(const std::string& root, const std::string& frame) const;

 private:
  struct Link {
    std::string parent;
    Pose pose;
  };
  std::map<std::string, Link> links_;  // by child
};

}  // namespace swiftlet
