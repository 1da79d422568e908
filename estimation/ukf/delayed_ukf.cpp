// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/ukf/delayed_ukf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace swiftlet {
namespace {

ImuSample between(const ImuSample& a, const ImuSample& b, double share) {
  return {a.angular_velocity + share * (b.angular_velocity - a.angular_velocity),
          a.specific_force + share * (b.specific_force - a.specific_force)};
}

}  // namespace

DelayedUkf::DelayedUkf(const Params& params)
    : params_(params), anchor_(params.ukf), present_(params.ukf) {
  if (!(params.max_delay > 0.0 && params.max_delay < 10.0)) {
    throw std::invalid_argument("UKF: max_delay is between 0 and 10 s");
  }
}

Status DelayedUkf::initialize(Time time, const PoseMeasurement& measurement) {
  if (Status status = anchor_.initialize(time, measurement); !status) return status;
  present_ = anchor_;
  samples_.clear();
  after_gap_.clear();
  before_.reset();
  return {};
}

Status DelayedUkf::predict(Time time, const ImuSample& imu) {
  Status status = present_.predict(time, imu);
  if (status.ok()) {
    samples_.push_back({time, imu});
    after_gap_.clear();
    advance_anchor(time - from_seconds(params_.max_delay));
  } else if (initialized() && time > present_.time() && present_.check(imu).ok()) {
    keep_after_gap({time, imu});
  }
  return status;
}

void DelayedUkf::keep_after_gap(const Sample& sample) {
  const auto seconds_to = [&sample](const Sample& other) {
    return to_seconds(sample.time) - to_seconds(other.time);
  };
  // A single stamp from the far future ends here.
  if (!after_gap_.empty() && sample.time <= after_gap_.back().time) after_gap_.clear();
  after_gap_.push_back(sample);
  const auto recent = std::find_if(after_gap_.begin(), after_gap_.end(), [&](const Sample& other) {
    return seconds_to(other) <= params_.max_delay;
  });
  after_gap_.erase(after_gap_.begin(), recent);
}

/// Predicts the anchor with the samples up to `time`.
void DelayedUkf::advance_anchor(Time time) {
  auto next = samples_.begin();
  for (; next != samples_.end() && next->time <= time; ++next) {
    before_ = *next;
    // After a restart some lie before it.
    if (next->time >= anchor_.time()) (void)anchor_.predict(next->time, next->imu);
  }
  samples_.erase(samples_.begin(), next);
}

/// Brings the anchor to `time`, with the sample that would have been taken then.
void DelayedUkf::move_anchor(Time time) {
  advance_anchor(time);
  if (samples_.empty() || anchor_.time() >= time) return;
  const Sample& next = samples_.front();
  ImuSample imu = next.imu;
  if (before_) {
    const double whole = to_seconds(next.time - before_->time);
    imu = between(before_->imu, imu, to_seconds(time - before_->time) / whole);
  }
  (void)anchor_.predict(time, imu);
}

void DelayedUkf::predict_present() {
  present_ = anchor_;
  for (const Sample& sample : samples_) (void)present_.predict(sample.time, sample.imu);
}

UpdateReport DelayedUkf::update(Time time, const PoseMeasurement& measurement) {
  if (initialized() && time < anchor_.time()) {
    UpdateReport report;
    report.reason = fmt::format("pose is {:.6g} s older than the last one, or than {} s",
                                to_seconds(anchor_.time()) - to_seconds(time), params_.max_delay);
    return report;
  }
  // What is ahead by more than prediction bridges ends a gap or is no time at all: the anchor
  // stays.
  if (to_seconds(time) - to_seconds(present_.time()) <= params_.ukf.max_step) move_anchor(time);
  UpdateReport report = anchor_.update(time, measurement);
  if (report.outcome == UpdateReport::Outcome::kReinitialized) {
    for (const Sample& sample : after_gap_) {
      if (sample.time > anchor_.time()) samples_.push_back(sample);
    }
    after_gap_.clear();
  } else if (report.outcome != UpdateReport::Outcome::kUsed) {
    return report;
  }
  predict_present();
  return report;
}

}  // namespace swiftlet
