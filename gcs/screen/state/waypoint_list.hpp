// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "control/flight_director.hpp"

namespace swiftlet::screen {

/// The waypoints that a person puts together before they are flown. All edits go through here. One
/// of them is selected, where there are any.
class WaypointList {
 public:
  const std::vector<MissionWaypoint>& items() const { return items_; }
  bool empty() const { return items_.empty(); }
  /// Index; 0 where there are none.
  int selected() const { return selected_; }
  void select(int index);
  void select_next() { select(selected_ + 1); }
  void select_previous() { select(selected_ - 1); }

  /// Behind the last one; it is selected then.
  void append(const Eigen::Vector3d& place);
  /// In front of the selected one; it is selected then.
  void insert(const Eigen::Vector3d& place);
  /// The selected one goes elsewhere, at its height.
  void move_to(const Eigen::Vector2d& place);
  void set_height(double height);
  void remove();
  void clear() { replace({}); }
  /// The selected one changes places with the one before or behind it.
  void earlier() { swap_with(selected_ - 1); }
  void later() { swap_with(selected_ + 1); }
  /// All of them, from a file or from the vehicle.
  void replace(std::vector<MissionWaypoint> items);

  /// From one to the next [m].
  double length() const;

 private:
  void swap_with(int other);
  MissionWaypoint* current();

  std::vector<MissionWaypoint> items_;
  int selected_ = 0;
};

}  // namespace swiftlet::screen
