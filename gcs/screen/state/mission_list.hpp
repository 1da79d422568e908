// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gcs/mission/mission_file.hpp"

namespace swiftlet::screen {

/// Where an item leads, seen from above, in the map [m]; nothing where it leads nowhere, or to a
/// place on Earth and nobody says where the map is there.
std::optional<Eigen::Vector2d> place_in_map(const MissionItem& item,
                                            const std::optional<LocalOrigin>& origin);

/// The mission that a person puts together before it is flown, with all that a file or the vehicle
/// may have in one. All edits go through here; what keys add are waypoints, a take-off and an end.
/// One of the items is selected, where there are any.
class MissionList {
 public:
  const MissionFile& mission() const { return mission_; }
  const std::vector<WrittenItem>& items() const { return mission_.items; }
  std::size_t size() const { return mission_.items.size(); }
  bool empty() const { return mission_.items.empty(); }
  /// Index; 0 where there are none.
  int selected() const { return selected_; }
  /// Null where there are none.
  const MissionItem* current() const;
  void select(int index);
  void select_next() { select(selected_ + 1); }
  void select_previous() { select(selected_ - 1); }

  /// Behind the last one, or the last before a return or a landing that ends it; it is selected
  /// then.
  void append(const Eigen::Vector3d& place);
  void append_global(const GlobalWaypoint& place);
  /// In front of all, where there is none.
  void put_takeoff(double altitude);
  /// A return or a landing at the end, in place of the one that is there.
  void put_end(MissionItem::Kind kind);
  /// In front of the selected one; it is selected then.
  void insert(const Eigen::Vector3d& place);
  /// The selected one goes elsewhere, at its height. An error where it has no place, or one on
  /// Earth and nobody says where the map is there.
  Status move_to(const Eigen::Vector2d& place, const std::optional<LocalOrigin>& origin);
  /// Of the selected one, as it is written [m]: in the map, or above the take-off point. Nothing
  /// where it has none.
  std::optional<double> height() const;
  void set_height(double height);
  /// In the map, of the waypoint that is nearest before the selected one, else behind it [m].
  std::optional<double> height_nearby() const;
  void remove();
  void clear() { replace({}); }
  /// The selected one changes places with the one before or behind it.
  void earlier() { swap_with(selected_ - 1); }
  void later() { swap_with(selected_ + 1); }
  /// All of it, from a file or from the vehicle.
  void replace(MissionFile mission);

  /// Counts the edits.
  std::uint64_t revision() const { return revision_; }
  /// As it is now, it is in a file; "": elsewhere, under no name.
  void set_kept(const std::string& file);
  /// Whether nothing would be lost with it.
  bool is_kept() const { return empty() || kept_ == revision_; }
  /// That it came from, or was saved in last; "" where there is none.
  const std::string& file() const { return file_; }

 private:
  void swap_with(int other);
  MissionItem* edited();
  bool is_ended() const;
  void append(WrittenItem written);

  MissionFile mission_;
  int selected_ = 0;
  std::uint64_t revision_ = 0;
  std::uint64_t kept_ = 0;
  std::string file_;
};

}  // namespace swiftlet::screen
