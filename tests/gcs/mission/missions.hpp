// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Missions for tests, and what they are compared by.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "gcs/mission/mission_file.hpp"

namespace swiftlet {

inline constexpr double kTurn = 6.283185307179586;

inline std::filesystem::path mission_data(const std::string& name) {
  return std::filesystem::path(SWIFTLET_SOURCE_DIR) / "tests/gcs/mission/data" / name;
}

inline std::string text_of_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The reason why a text cannot be read, "" where it can.
inline std::string error_of(MissionForm form, const std::string& text,
                            const MissionReading& reading = {}) {
  const auto mission = parse_mission(form, text, "m", reading);
  return mission.ok() ? "" : mission.error().reason;
}

inline MissionItem item_of(MissionItem::Kind kind) {
  MissionItem item;
  item.kind = kind;
  return item;
}
inline MissionItem takeoff_to(double altitude) {
  MissionItem item = item_of(MissionItem::Kind::kTakeoff);
  item.altitude = altitude;
  return item;
}
inline MissionItem in_map(double x, double y, double z) {
  MissionItem item;
  item.place.position = {x, y, z};
  return item;
}
inline MissionItem on_earth(double latitude, double longitude, double altitude) {
  MissionItem item;
  item.global = GlobalWaypoint{latitude, longitude, altitude};
  return item;
}
inline MissionItem hold_for(double seconds) {
  MissionItem item = item_of(MissionItem::Kind::kHold);
  item.hold = seconds;
  return item;
}

/// One item a line, from line 1.
inline MissionFile mission_of(const std::vector<MissionItem>& items) {
  MissionFile mission;
  for (const MissionItem& item : items) {
    mission.items.push_back({item, static_cast<int>(mission.items.size() + 1)});
  }
  return mission;
}

/// Numbers with all digits that a double has.
class MissionMaker {
 public:
  explicit MissionMaker(unsigned seed) : random_(seed) {}

  double number(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }
  bool flip() { return (random_() & 1u) != 0; }
  std::size_t below(std::size_t count) { return random_() % count; }

  MissionItem waypoint(bool global) {
    MissionItem item = in_map(number(-99, 99), number(-99, 99), number(0, 9));
    if (global) item = on_earth(number(-90, 90), number(-180, 180), number(0.1, 200));
    if (global && flip()) item.place.speed = number(0.1, 50);
    // As a file says it: degrees.
    if (flip()) item.place.yaw = std::round(number(-179, 180) * 1000) / 1000 * (kTurn / 360);
    if (flip()) item.hold = number(0, 3600);
    return item;
  }

  /// Of such as a form holds: MAVLink's know no map.
  MissionFile mission(bool with_map) {
    MissionFile mission;
    mission.home = GlobalPosition{number(-90, 90), number(-180, 180), number(-100, 5000)};
    if (flip()) mission.cruise_speed = number(0.1, 20);
    const std::size_t count = 1 + below(20);
    for (std::size_t i = 0; i < count; ++i) mission.items.push_back({any_item(with_map), 0});
    for (std::size_t i = below(3); i > 0; --i) mission.fence.push_back(zone());
    return mission;
  }

  std::mt19937& random() { return random_; }

 private:
  MissionItem any_item(bool with_map) {
    switch (below(8)) {
      case 0:
        return takeoff_to(number(0, 100));
      case 1:
        return hold_for(number(0, 3600));
      case 2:
        return item_of(MissionItem::Kind::kLand);
      case 3:
        return item_of(MissionItem::Kind::kReturn);
      case 4: {
        MissionItem claw = item_of(MissionItem::Kind::kClaw);
        claw.open = flip();
        return claw;
      }
      default:
        return waypoint(!with_map || flip());
    }
  }
  FenceZone zone() {
    FenceZone zone;
    zone.stay_inside = flip();
    if (flip()) {
      zone.centre = {number(-90, 90), number(-180, 180), 0.0};
      zone.radius = number(1, 1000);
      return zone;
    }
    for (std::size_t i = 3 + below(4); i > 0; --i) {
      zone.corners.push_back({number(-90, 90), number(-180, 180), 0.0});
    }
    return zone;
  }

  std::mt19937 random_;
};

/// What of a mission a person would call another one; "" where nothing is. Numbers to the bit, but
/// headings within a rounding where `yaw_tolerance` allows it.
inline std::string difference(const MissionItem& a, const MissionItem& b, double yaw_tolerance) {
  if (a.kind != b.kind) return "kind";
  if (a.kind == MissionItem::Kind::kTakeoff) return a.altitude == b.altitude ? "" : "altitude";
  if (a.kind == MissionItem::Kind::kClaw) return a.open == b.open ? "" : "open";
  if (a.kind == MissionItem::Kind::kHold) return a.hold == b.hold ? "" : "hold";
  if (a.kind != MissionItem::Kind::kWaypoint) return "";
  if (a.hold != b.hold) return "hold";
  if (a.place.speed != b.place.speed) return "speed";
  if (a.place.yaw.has_value() != b.place.yaw.has_value()) return "yaw or none";
  const double turn = std::remainder(a.place.yaw.value_or(0) - b.place.yaw.value_or(0), kTurn);
  if (std::abs(turn) > yaw_tolerance) return "yaw";
  if (a.global.has_value() != b.global.has_value()) return "map or Earth";
  if (!a.global) return a.place.position == b.place.position ? "" : "position";
  const bool is_same = a.global->latitude == b.global->latitude &&
                       a.global->longitude == b.global->longitude &&
                       a.global->altitude == b.global->altitude;
  return is_same ? "" : "place on Earth";
}

inline void expect_same_items(const MissionFile& read, const MissionFile& written,
                              double yaw_tolerance = 0.0) {
  ASSERT_EQ(read.items.size(), written.items.size());
  for (std::size_t i = 0; i < read.items.size(); ++i) {
    EXPECT_EQ(difference(read.items[i].item, written.items[i].item, yaw_tolerance), "")
        << "item " << i + 1;
  }
}

inline void expect_same_fence(const MissionFile& read, const MissionFile& written) {
  const auto flat = [](const MissionFile& mission, bool circles) {
    std::vector<double> numbers;
    for (const FenceZone& zone : mission.fence) {
      if (zone.corners.empty() != circles) continue;
      numbers.insert(numbers.end(), {zone.stay_inside ? 1.0 : 0.0, zone.centre.latitude,
                                     zone.centre.longitude, zone.radius});
      for (const auto& corner : zone.corners) {
        numbers.insert(numbers.end(), {corner.latitude, corner.longitude});
      }
    }
    return numbers;
  };
  EXPECT_EQ(flat(read, true), flat(written, true));
  EXPECT_EQ(flat(read, false), flat(written, false));
}

}  // namespace swiftlet
