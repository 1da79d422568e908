// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "gcs/mission/degrees.hpp"
#include "gcs/mission/mavlink_item.hpp"

namespace swiftlet {
namespace {

using Kind = MissionItem::Kind;

constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();
constexpr double kUsualSpeed = -2.0;  // the vehicle's own, as DO_CHANGE_SPEED says it

/// Names an item in errors: "item 3 (line 9)".
std::string name_of(const MissionFile& mission, std::size_t index) {
  const int line = mission.items[index].line;
  return line > 0 ? fmt::format("item {} (line {})", index + 1, line)
                  : fmt::format("item {}", index + 1);
}

class Export {
 public:
  explicit Export(MavlinkMission& mission) : mission_(mission) {}

  void add(const MissionItem& item, int line);

 private:
  void add(int command, std::array<double, 7> params, int frame = mav::kFrameMission) {
    mission_.items.push_back({line_, frame, command, params, true});
  }
  void fly_to(const MissionItem& item);
  void set_speed(double speed);

  MavlinkMission& mission_;
  int line_ = 0;
  double speed_ = kUsualSpeed;  // that was told last [m/s]
  GlobalWaypoint place_;        // of the last waypoint; 0, 0 stands for "here"
};

void Export::set_speed(double speed) {
  constexpr double kGroundSpeed = 1.0, kSameThrottle = -1.0;
  if (speed == speed_) return;
  add(mav::kChangeSpeed, {kGroundSpeed, speed, kSameThrottle, 0, 0, 0, 0});
  speed_ = speed;
}

void Export::fly_to(const MissionItem& item) {
  set_speed(item.place.speed.value_or(kUsualSpeed));
  place_ = item.global.value_or(GlobalWaypoint{});
  const double yaw_deg =
      item.place.yaw ? std::stod(shortest_degrees(*item.place.yaw, from_compass)) : kNotGiven;
  add(mav::kWaypoint,
      {item.hold, 0, 0, yaw_deg, place_.latitude, place_.longitude, place_.altitude},
      mav::kFrameRelative);
}

void Export::add(const MissionItem& item, int line) {
  constexpr double kFirstGripper = 1.0, kRelease = 0.0, kGrab = 1.0, kNoTimeOfDay = -1.0;
  line_ = line;
  switch (item.kind) {
    case Kind::kTakeoff:
      return add(
          mav::kTakeoff,
          {0, 0, 0, kNotGiven, mission_.home.latitude, mission_.home.longitude, item.altitude},
          mav::kFrameRelative);
    case Kind::kWaypoint:
      return fly_to(item);
    case Kind::kHold:
      return add(mav::kDelay, {item.hold, kNoTimeOfDay, kNoTimeOfDay, kNoTimeOfDay, 0, 0, 0});
    case Kind::kLand:
      // Ground stations draw it where it has a place.
      return add(mav::kLand, {0, 0, 0, kNotGiven, place_.latitude, place_.longitude, 0},
                 mav::kFrameRelative);
    case Kind::kReturn:
      return add(mav::kReturnToLaunch, {});
    case Kind::kClaw:
      return add(mav::kGripper, {kFirstGripper, item.open ? kRelease : kGrab, 0, 0, 0, 0, 0});
  }
}

/// Why such files cannot hold an item; "" where they can.
std::string problem_for_mavlink(const MissionItem& item) {
  if (item.kind != Kind::kWaypoint) return "";
  if (!item.global) {
    return "a waypoint in the map is no place on Earth, and such files hold no others; write .yaml";
  }
  if (item.global->altitude == 0.0) {
    return "it has no altitude, and such files hold no waypoint without; give it one";
  }
  if (item.global->latitude == 0.0 && item.global->longitude == 0.0) {
    return "latitude and longitude 0 stand for 'here' in such files; move it";
  }
  return "";
}

}  // namespace

Result<MavlinkMission> to_mavlink(const MissionFile& mission) {
  MavlinkMission result;
  for (std::size_t i = 0; i < mission.items.size(); ++i) {
    const std::string problem = problem_for_mavlink(mission.items[i].item);
    if (!problem.empty()) return Error{fmt::format("{}: {}", name_of(mission, i), problem)};
  }
  const auto first =
      std::find_if(mission.items.begin(), mission.items.end(),
                   [](const WrittenItem& written) { return written.item.global.has_value(); });
  if (mission.home) {
    result.home = *mission.home;
  } else if (first != mission.items.end()) {
    const GlobalWaypoint& place = *first->item.global;
    result.home = {place.latitude, place.longitude, 0.0};
    result.losses.push_back(
        {0, "the mission does not say where home is; the first waypoint's place is written"});
  } else {
    return Error{
        "such files say where home is, and the mission has no place on Earth; give 'home'"};
  }
  Export writer(result);
  for (const WrittenItem& written : mission.items) writer.add(written.item, written.line);
  return result;
}

}  // namespace swiftlet
