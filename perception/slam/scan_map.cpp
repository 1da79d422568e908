// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/scan_map.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet {
namespace {

// Of a cell; and a turn that moves what is as far as walls usually are by that much.
constexpr double kMoved = 0.5;
constexpr double kUsualRange = 8.0;  // [m]

}  // namespace

bool ScanMap::has_moved(const std::vector<Pose2>& poses) const {
  const double limit = kMoved * grid_.resolution();
  for (std::size_t i = 0; i < drawn_at_.size(); ++i) {
    const double turned = std::abs(wrap_angle(poses[i].yaw - drawn_at_[i].yaw));
    if ((poses[i].position - drawn_at_[i].position).norm() + kUsualRange * turned > limit) {
      return true;
    }
  }
  return false;
}

void ScanMap::update(const std::vector<LevelledScanPtr>& scans, const std::vector<Pose2>& poses) {
  const std::size_t count = std::min(scans.size(), poses.size());
  if (count < drawn_at_.size() || has_moved(poses)) {
    grid_ = OccupancyGrid(grid_.params());
    drawn_at_.clear();
    refused_ = 0;
    ++redrawn_;
  }
  for (std::size_t i = drawn_at_.size(); i < count; ++i) {
    const Eigen::Vector3d p_WL(poses[i].position.x(), poses[i].position.y(),
                               scans[i]->motion.height);
    const Eigen::AngleAxisd yaw(poses[i].yaw, Eigen::Vector3d::UnitZ());
    const auto inserted = grid_.insert(scans[i]->scan, p_WL, yaw * scans[i]->motion.q_HL);
    refused_ += inserted.ok() ? 0 : 1;
    drawn_at_.push_back(poses[i]);
  }
}

}  // namespace swiftlet
