// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/euroc/motion_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/experiments/data_table.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr Duration kLongestGap = 250ms;
constexpr Duration kHalfBaseline = 50ms;  // of velocities by differences
constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kEurocColumns = 11;

}  // namespace

Result<MotionLog> MotionLog::read(const std::filesystem::path& file) {
  const auto table = read_table(file);
  if (!table) return table.error();
  const std::size_t columns = table->front().size();
  const bool is_tum = columns == kTumColumns;
  if (!is_tum && columns < kEurocColumns) {
    return Error{
        fmt::format("{}: {} columns; motion has 8 (time, position, quaternion x y z w) or "
                    "at least 11 (time, position, quaternion w x y z, velocity)",
                    file.string(), columns)};
  }
  MotionLog log;
  for (const std::vector<double>& row : *table) {
    Sample sample;
    // A double has nanoseconds since 1970 to 256 of them only.
    sample.time = is_tum ? Time(std::chrono::microseconds(std::llround(row[0] * 1e6)))
                         : Time(std::chrono::microseconds(std::llround(row[0] / 1e3)));
    sample.state.p_WB = {row[1], row[2], row[3]};
    sample.state.q_WB = is_tum ? Quaterniond(row[7], row[4], row[5], row[6])
                               : Quaterniond(row[4], row[5], row[6], row[7]);
    if (!is_tum) sample.state.v_WB_W = {row[8], row[9], row[10]};
    const double length = sample.state.q_WB.norm();
    if (!(std::abs(length - 1.0) < 0.01) || !sample.state.p_WB.allFinite() ||
        !sample.state.v_WB_W.allFinite()) {
      return Error{fmt::format("{}: what stands at time {} is no pose", file.string(), row[0])};
    }
    sample.state.q_WB.normalize();
    if (!log.samples_.empty() && sample.time <= log.samples_.back().time) {
      return Error{fmt::format("{}: time does not rise at {}", file.string(), row[0])};
    }
    log.samples_.push_back(sample);
  }
  if (is_tum) log.differentiate();
  return log;
}

/// Velocities from positions.
void MotionLog::differentiate() {
  std::size_t low = 0, high = 0;
  std::vector<Vector3d> velocities;
  for (const Sample& sample : samples_) {
    while (samples_[low].time < sample.time - kHalfBaseline) ++low;
    while (high + 1 < samples_.size() && samples_[high + 1].time <= sample.time + kHalfBaseline) {
      ++high;
    }
    const double dt = to_seconds(samples_[high].time - samples_[low].time);
    velocities.push_back(dt > 0.0
                             ? Vector3d((samples_[high].state.p_WB - samples_[low].state.p_WB) / dt)
                             : Vector3d(Vector3d::Zero()));
  }
  for (std::size_t i = 0; i < samples_.size(); ++i) samples_[i].state.v_WB_W = velocities[i];
}

std::optional<RigidBodyState> MotionLog::at(Time time) const {
  if (time < begin() || time > end()) return std::nullopt;
  auto after = std::lower_bound(samples_.begin(), samples_.end(), time,
                                [](const Sample& sample, Time at) { return sample.time < at; });
  if (after == samples_.begin()) ++after;
  if (after == samples_.end()) return samples_.back().state;
  const Sample& a = *std::prev(after);
  const Sample& b = *after;
  if (b.time - a.time > kLongestGap) return std::nullopt;
  const double T = to_seconds(b.time - a.time);
  const double s = to_seconds(time - a.time) / T;
  const double s2 = s * s, s3 = s2 * s;
  RigidBodyState state;
  state.p_WB = (2 * s3 - 3 * s2 + 1) * a.state.p_WB + (s3 - 2 * s2 + s) * T * a.state.v_WB_W +
               (3 * s2 - 2 * s3) * b.state.p_WB + (s3 - s2) * T * b.state.v_WB_W;
  state.v_WB_W = (6 * s2 - 6 * s) / T * (a.state.p_WB - b.state.p_WB) +
                 (3 * s2 - 4 * s + 1) * a.state.v_WB_W + (3 * s2 - 2 * s) * b.state.v_WB_W;
  state.q_WB = a.state.q_WB.slerp(s, b.state.q_WB);
  state.w_WB_B = log_so3(a.state.q_WB.conjugate() * b.state.q_WB) / T;
  return state;
}

}  // namespace swiftlet
