// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "tests/perception/slam/floor_plan.hpp"

namespace swiftlet::test {

/// A house of rooms, doors and furniture that nobody has seen before: walls that cut it again and
/// again, each with a door, some with two, and boxes along the walls.
struct RandomHouse {
  struct Box {
    Eigen::Vector2d lower, upper;
  };

  explicit RandomHouse(unsigned seed) : random(seed) {
    const double t = kWall;
    add({-t, -t}, {kWidth + t, 0.0});
    add({-t, kHeight}, {kWidth + t, kHeight + t});
    add({-t, 0.0}, {0.0, kHeight});
    add({kWidth, 0.0}, {kWidth + t, kHeight});
    cut({{0.0, 0.0}, {kWidth, kHeight}});
    furnish();
    for (const Box& box : boxes) plan.add_box(box.lower, box.upper);
  }

  /// Whether nothing is nearer than `distance`.
  bool is_free(const Eigen::Vector2d& point, double distance) const {
    return std::all_of(boxes.begin(), boxes.end(), [&](const Box& box) {
      return (point - point.cwiseMax(box.lower).cwiseMin(box.upper)).norm() >= distance;
    });
  }
  Eigen::Vector2d free_place(double distance) {
    for (;;) {
      const Eigen::Vector2d place(uniform(0.0, kWidth), uniform(0.0, kHeight));
      if (is_free(place, distance)) return place;
    }
  }
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  }

  static constexpr double kWidth = 14.0, kHeight = 10.0, kWall = 0.12;
  std::mt19937 random;
  std::vector<Box> boxes;
  std::vector<Eigen::Vector2d> doors;
  std::vector<Box> rooms;
  FloorPlan plan;

 private:
  static constexpr double kLeastRoom = 2.8, kDoor = 1.0;

  void add(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper) {
    boxes.push_back({lower, upper});
  }

  void cut(const Box& room) {
    const Eigen::Vector2d size = room.upper - room.lower;
    const int axis = size.x() > size.y() ? 0 : 1, along = 1 - axis;
    if (size[axis] < 2.0 * kLeastRoom + kWall) {
      rooms.push_back(room);
      return;
    }
    const double at = uniform(room.lower[axis] + kLeastRoom, room.upper[axis] - kLeastRoom - kWall);
    std::vector<double> gaps{uniform(room.lower[along] + 0.3, room.upper[along] - 0.3 - kDoor)};
    if (size[along] > 6.0) {
      const double other = uniform(room.lower[along] + 0.3, room.upper[along] - 0.3 - kDoor);
      if (std::abs(other - gaps[0]) > 2.0) gaps.push_back(other);
    }
    std::sort(gaps.begin(), gaps.end());
    double from = room.lower[along];
    for (std::size_t i = 0; i <= gaps.size(); ++i) {
      const double to = i < gaps.size() ? gaps[i] : room.upper[along];
      Box wall;
      wall.lower[axis] = at;
      wall.upper[axis] = at + kWall;
      wall.lower[along] = from;
      wall.upper[along] = to;
      if (to > from) boxes.push_back(wall);
      if (i == gaps.size()) break;
      Eigen::Vector2d door;
      door[axis] = at + 0.5 * kWall;
      door[along] = gaps[i] + 0.5 * kDoor;
      doors.push_back(door);
      from = gaps[i] + kDoor;
    }
    Box first = room, second = room;
    first.upper[axis] = at;
    second.lower[axis] = at + kWall;
    cut(first);
    cut(second);
    clear_doors();
  }

  /// A wall that would end in a door leaves it open.
  void clear_doors() {
    for (const Eigen::Vector2d& door : doors) {
      for (Box& box : boxes) {
        const bool blocks =
            (door - door.cwiseMax(box.lower).cwiseMin(box.upper)).norm() < 0.5 * kDoor - 1e-6;
        const bool inner =
            box.lower.minCoeff() >= 0.0 && box.upper.x() <= kWidth && box.upper.y() <= kHeight;
        if (!blocks || !inner) continue;
        const int along = box.upper.x() - box.lower.x() > box.upper.y() - box.lower.y() ? 0 : 1;
        if (door[along] < 0.5 * (box.lower[along] + box.upper[along])) {
          box.lower[along] = std::min(box.upper[along], door[along] + 0.5 * kDoor);
        } else {
          box.upper[along] = std::max(box.lower[along], door[along] - 0.5 * kDoor);
        }
      }
    }
  }

  void furnish() {
    for (const Box& room : rooms) {
      const int count = std::uniform_int_distribution<int>(1, 4)(random);
      for (int i = 0; i < count; ++i) {
        const Eigen::Vector2d size(uniform(0.3, 1.4), uniform(0.3, 0.9));
        Eigen::Vector2d lower(uniform(room.lower.x(), room.upper.x() - size.x()),
                              uniform(room.lower.y(), room.upper.y() - size.y()));
        // Most stand at a wall.
        if (uniform(0.0, 1.0) < 0.7) {
          const int axis = uniform(0.0, 1.0) < 0.5 ? 0 : 1;
          lower[axis] = uniform(0.0, 1.0) < 0.5 ? room.lower[axis] : room.upper[axis] - size[axis];
        }
        const Box box{lower, lower + size};
        const bool in_the_way =
            std::any_of(doors.begin(), doors.end(), [&](const Eigen::Vector2d& door) {
              return (door - door.cwiseMax(box.lower).cwiseMin(box.upper)).norm() < 1.1;
            });
        if (!in_the_way) boxes.push_back(box);
      }
    }
  }
};

}  // namespace swiftlet::test
