// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/path_error.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet {
namespace {

/// A position waits so long for a reference that comes later in the recording [s].
constexpr double kPatience = 1.0;

}  // namespace

void PathError::add_position(double time, const Eigen::Vector3d& position) {
  if (!position.allFinite()) return;
  waiting_.push_back({time, position});
  while (waiting_.front().time < time - kPatience) waiting_.pop_front();
}

void PathError::add_reference(double time, const Eigen::Vector3d& reference) {
  if (!reference.allFinite()) {
    end_reference();
    return;
  }
  const bool joined =
      reference_ && time >= reference_->time && time - reference_->time <= longest_gap_;
  while (!waiting_.empty() && waiting_.front().time <= time) {
    const Sample sample = waiting_.front();
    waiting_.pop_front();
    if (sample.time == time) {
      note({sample.time, sample.position - reference});
    } else if (joined && sample.time >= reference_->time) {
      const double s = (sample.time - reference_->time) / (time - reference_->time);
      note({sample.time,
            sample.position - (reference_->position + s * (reference - reference_->position))});
    }
  }
  reference_ = Sample{time, reference};
}

void PathError::end_reference() {
  reference_.reset();
}

void PathError::note(const At& at) {
  ++count_;
  squares_ += at.error.cwiseAbs2();
  largest_ = std::max(largest_, at.error.norm());
  if (on_error_) on_error_(at);
}

std::optional<Eigen::Vector3d> PathError::rms() const {
  if (count_ == 0) return std::nullopt;
  return Eigen::Vector3d((squares_ / static_cast<double>(count_)).cwiseSqrt());
}

void Track::add(double time, const Eigen::Vector3d& position) {
  if (!position.allFinite()) return;
  const double step = last_ ? (position - *last_).norm() : 0.0;
  if (last_ && step < kStep) return;
  last_ = position;
  length_ += step;
  if (steps_++ % keep_every_ != 0) return;
  points_.push_back({time, position.head<2>()});
  if (points_.size() < kMostPoints) return;
  for (std::size_t i = 0; 2 * i < points_.size(); ++i) points_[i] = points_[2 * i];
  points_.resize((points_.size() + 1) / 2);
  keep_every_ *= 2;
}

}  // namespace swiftlet
