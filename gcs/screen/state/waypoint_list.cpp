// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/state/waypoint_list.hpp"

#include <algorithm>

namespace swiftlet::screen {

MissionWaypoint* WaypointList::current() {
  return items_.empty() ? nullptr : &items_[static_cast<std::size_t>(selected_)];
}

void WaypointList::select(int index) {
  selected_ = std::clamp(index, 0, std::max(0, static_cast<int>(items_.size()) - 1));
}

void WaypointList::append(const Eigen::Vector3d& place) {
  items_.push_back({place, std::nullopt});
  select(static_cast<int>(items_.size()));
}

void WaypointList::insert(const Eigen::Vector3d& place) {
  items_.insert(items_.begin() + selected_, {place, std::nullopt});
}

void WaypointList::move_to(const Eigen::Vector2d& place) {
  if (MissionWaypoint* waypoint = current()) waypoint->position.head<2>() = place;
}

void WaypointList::set_height(double height) {
  if (MissionWaypoint* waypoint = current()) waypoint->position.z() = height;
}

void WaypointList::remove() {
  if (items_.empty()) return;
  items_.erase(items_.begin() + selected_);
  select(selected_);
}

void WaypointList::replace(std::vector<MissionWaypoint> items) {
  items_ = std::move(items);
  selected_ = 0;
}

void WaypointList::swap_with(int other) {
  if (other < 0 || other >= static_cast<int>(items_.size())) return;
  std::swap(items_[static_cast<std::size_t>(selected_)], items_[static_cast<std::size_t>(other)]);
  selected_ = other;
}

double WaypointList::length() const {
  double length = 0.0;
  for (std::size_t i = 1; i < items_.size(); ++i) {
    length += (items_[i].position - items_[i - 1].position).norm();
  }
  return length;
}

}  // namespace swiftlet::screen
