// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/slam/relations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "components/experiments/data_table.hpp"

namespace swiftlet {
namespace {

constexpr std::size_t kColumns = 8;

Pose2 pose_at(const std::vector<TimedPose2>& trajectory, double t) {
  const auto after =
      std::lower_bound(trajectory.begin() + 1, trajectory.end() - 1, t,
                       [](const TimedPose2& pose, double time) { return pose.t < time; });
  const TimedPose2 &a = *(after - 1), &b = *after;
  const double share = b.t > a.t ? std::clamp((t - a.t) / (b.t - a.t), 0.0, 1.0) : 0.0;
  return between(a.pose, b.pose, share);
}

/// Mean and standard deviation.
std::pair<double, double> statistics(const std::vector<double>& values) {
  const double count = static_cast<double>(std::max<std::size_t>(1, values.size()));
  double mean = 0.0, variance = 0.0;
  for (const double value : values) mean += value / count;
  for (const double value : values) variance += (value - mean) * (value - mean) / count;
  return {mean, std::sqrt(variance)};
}

}  // namespace

Result<std::vector<PoseRelation>> read_relations(const std::filesystem::path& file) {
  const auto table = read_table(file);
  if (!table) return table.error();
  if (table->front().size() != kColumns) {
    return Error{fmt::format("{}: {} columns; a relation is 'from to dx dy dz roll pitch yaw'",
                             file.string(), table->front().size())};
  }
  std::vector<PoseRelation> relations;
  for (const std::vector<double>& row : *table) {
    relations.push_back({row[0], row[1], {{row[2], row[3]}, row[7]}});
  }
  return relations;
}

RelationErrors relation_errors(const std::vector<TimedPose2>& trajectory,
                               const std::vector<PoseRelation>& relations) {
  RelationErrors errors;
  if (trajectory.size() < 2) return errors;
  std::vector<double> translations, rotations;
  for (const PoseRelation& relation : relations) {
    const auto [first, last] = std::minmax(relation.from, relation.to);
    if (first < trajectory.front().t || last > trajectory.back().t) continue;
    const Pose2 estimated =
        pose_at(trajectory, relation.from).inverse() * pose_at(trajectory, relation.to);
    translations.push_back((estimated.position - relation.relative.position).norm());
    rotations.push_back(std::abs(wrap_angle(estimated.yaw - relation.relative.yaw)));
  }
  errors.count = translations.size();
  std::tie(errors.translation_mean, errors.translation_std) = statistics(translations);
  std::tie(errors.rotation_mean, errors.rotation_std) = statistics(rotations);
  return errors;
}

}  // namespace swiftlet
