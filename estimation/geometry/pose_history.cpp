// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/geometry/pose_history.hpp"

#include <algorithm>

namespace swiftlet {

void PoseHistory::add(Time time, const Pose& pose) {
  if (!poses_.empty() && time <= poses_.back().time) return;
  poses_.push_back({time, pose});
  while (poses_.back().time - poses_.front().time > length_) poses_.pop_front();
}

std::optional<PoseHistory::Pose> PoseHistory::at(Time time, Duration max_gap) const {
  const auto after = std::lower_bound(poses_.begin(), poses_.end(), time,
                                      [](const Entry& entry, Time t) { return entry.time < t; });
  if (after == poses_.end()) return std::nullopt;
  if (after->time == time) return after->pose;
  if (after == poses_.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const Duration gap = after->time - before->time;
  if (gap > max_gap) return std::nullopt;
  const double fraction = to_seconds(time - before->time) / to_seconds(gap);
  Pose pose;
  pose.position = before->pose.position + fraction * (after->pose.position - before->pose.position);
  pose.attitude = before->pose.attitude.slerp(fraction, after->pose.attitude);
  return pose;
}

}  // namespace swiftlet
