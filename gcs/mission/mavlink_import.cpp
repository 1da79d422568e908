// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <set>

#include "gcs/mission/degrees.hpp"
#include "gcs/mission/line_problem.hpp"
#include "gcs/mission/mavlink_item.hpp"

namespace swiftlet {
namespace {

using Kind = MissionItem::Kind;

/// A take-off that is planned farther from home is said not to be there [m].
constexpr double kSamePlace = 5.0;

// Other values of MAV_FRAME.
constexpr int kFrameSeaInt = 5;
constexpr int kFrameRelativeInt = 6;
constexpr int kFrameTerrain = 10;
constexpr int kFrameTerrainInt = 11;

/// Goes through the items as a vehicle of MAVLink's would.
class Import {
 public:
  Import(std::optional<double> home_altitude, MissionFile& mission)
      : home_altitude_(home_altitude), mission_(mission) {}

  void add(const MavlinkItem& item);

 private:
  void take_off(const MavlinkItem& item);
  void fly_to(const MavlinkItem& item, double hold, double yaw_deg);
  void hold(const MavlinkItem& item, double seconds);
  void loiter(const MavlinkItem& item);
  void land(const MavlinkItem& item);
  void change_speed(const MavlinkItem& item);
  void move_claw(const MavlinkItem& item);

  double altitude_of(const MavlinkItem& item);
  void add(const MavlinkItem& source, Kind kind) { push(source, simple(kind)); }
  static MissionItem simple(Kind kind) {
    MissionItem item;
    item.kind = kind;
    return item;
  }
  void push(const MavlinkItem& source, const MissionItem& item) {
    mission_.items.push_back({item, source.line});
  }
  void remark(const MavlinkItem& item, const std::string& what) {
    mission_.remarks.push_back(
        {item.line, fmt::format("{}: {}", mav_command_name(item.command), what)});
  }
  /// The same for what is said once for all items.
  void remark_once(const MavlinkItem& item, const std::string& what) {
    if (said_.insert(what).second) mission_.remarks.push_back({item.line, what});
  }

  std::optional<double> home_altitude_;  // above sea [m]
  MissionFile& mission_;
  std::optional<double> speed_;          // of the waypoints that follow [m/s]
  std::optional<GlobalWaypoint> place_;  // flown to last
  double altitude_ = 0.0;  // at the end of the last item, above the take-off point [m]
  std::set<std::string> said_;
};

double or_zero(double value) {
  return std::isnan(value) ? 0.0 : value;
}

/// Above the take-off point [m].
double Import::altitude_of(const MavlinkItem& item) {
  if (std::isnan(item.altitude())) {
    throw LineProblem(item.line, fmt::format("{} has no altitude; give its seventh parameter",
                                             mav_command_name(item.command)));
  }
  switch (item.frame) {
    case mav::kFrameRelative:
    case kFrameRelativeInt:
      return item.altitude();
    case kFrameTerrain:
    case kFrameTerrainInt:
      remark_once(item,
                  fmt::format("altitudes above terrain (frame {}) are flown above the take-off "
                              "point: the terrain is not known",
                              item.frame));
      return item.altitude();
    case mav::kFrameSea:
    case kFrameSeaInt:
      break;
    default:
      throw LineProblem(item.line,
                        fmt::format("{} is in frame {}, which is not supported; use altitudes "
                                    "above home (frame 3)",
                                    mav_command_name(item.command), item.frame));
  }
  if (!home_altitude_) {
    throw LineProblem(
        item.line,
        fmt::format("{} has an altitude of {} m above sea (frame {}), and nobody says how high the "
                    "take-off point is; use --home-altitude, or frame 3",
                    mav_command_name(item.command), item.altitude(), item.frame));
  }
  remark_once(item, fmt::format("altitudes above sea (frame {}) became heights above the take-off "
                                "point, which is at {:.1f} m",
                                item.frame, *home_altitude_));
  return item.altitude() - *home_altitude_;
}

void Import::take_off(const MavlinkItem& item) {
  MissionItem takeoff = simple(Kind::kTakeoff);
  takeoff.altitude = altitude_ = altitude_of(item);
  push(item, takeoff);
  if (!item.has_place()) return;
  const GlobalPosition place{item.latitude(), item.longitude(), 0.0};
  if (mission_.home && place.usable()) {
    GlobalPosition home = *mission_.home;
    home.altitude = 0.0;
    if (LocalOrigin(home).to_map(place).head<2>().norm() <= kSamePlace) return;
  }
  remark(item, fmt::format("the vehicle climbs where it stands, and does not fly to {:.6f}, {:.6f}",
                           place.latitude, place.longitude));
}

void Import::fly_to(const MavlinkItem& item, double hold, double yaw_deg) {
  if (!item.has_place()) {
    throw LineProblem(item.line, fmt::format("{} has no place: latitude and longitude are 0 or "
                                             "absent; give them",
                                             mav_command_name(item.command)));
  }
  const double altitude = altitude_of(item);
  if (altitude == 0.0) {
    remark(item, "an altitude of 0 m cannot be flown to; it is flown at the usual one");
  }
  MissionItem waypoint;
  waypoint.global = place_ = GlobalWaypoint{item.latitude(), item.longitude(), altitude};
  waypoint.hold = hold;
  waypoint.place.speed = speed_;
  if (!std::isnan(yaw_deg)) waypoint.place.yaw = from_compass(yaw_deg);
  push(item, waypoint);
  altitude_ = altitude;
}

void Import::hold(const MavlinkItem& item, double seconds) {
  if (!(seconds >= 0.0)) {
    return remark(item, "a delay until a time of day is not supported; left out");
  }
  MissionItem hold = simple(Kind::kHold);
  hold.hold = seconds;
  push(item, hold);
}

void Import::loiter(const MavlinkItem& item) {
  constexpr double kNoYaw = std::numeric_limits<double>::quiet_NaN();  // it is no heading there
  const bool is_timed = item.command == mav::kLoiterTime;
  if (item.command == mav::kLoiterTurns) {
    remark(item, "circles are not supported; it is flown to, and no more");
  } else if (!is_timed) {
    remark(item,
           "it is flown to, and the next item follows at once; to stay there, let it be the last");
  }
  const double seconds = is_timed ? or_zero(item.params[0]) : 0.0;
  if (item.has_place()) return fly_to(item, seconds, kNoYaw);
  if (is_timed) hold(item, seconds);
}

/// To its place, at the altitude of the item before, and down.
void Import::land(const MavlinkItem& item) {
  const bool is_there =
      place_ && place_->latitude == item.latitude() && place_->longitude == item.longitude();
  if (item.has_place() && !is_there) {
    MissionItem above;
    above.global = GlobalWaypoint{item.latitude(), item.longitude(), altitude_};
    above.place.speed = speed_;
    push(item, above);
  }
  add(item, Kind::kLand);
}

void Import::change_speed(const MavlinkItem& item) {
  constexpr double kNoChange = -1.0, kUsual = -2.0, kGroundSpeed = 1.0;
  const double type = or_zero(item.params[0]), speed = item.params[1];
  if (type != 0.0 && type != kGroundSpeed) {
    return remark(item, "speeds of climbs and descents are the vehicle's own; left out");
  }
  if (std::isnan(speed) || speed == kNoChange) return;
  if (speed == kUsual) {
    speed_.reset();
  } else if (speed > 0.0) {
    speed_ = speed;
  } else {
    throw LineProblem(item.line, fmt::format("{} to {} m/s; give a speed above 0",
                                             mav_command_name(item.command), speed));
  }
}

void Import::move_claw(const MavlinkItem& item) {
  const double action = or_zero(item.params[1]);
  if (action != 0.0 && action != 1.0) {
    return remark(item,
                  fmt::format("action {} is neither release (0) nor grab (1); left out", action));
  }
  MissionItem claw = simple(Kind::kClaw);
  claw.open = action == 0.0;
  push(item, claw);
}

void Import::add(const MavlinkItem& item) {
  if (!item.continues) {
    remark(item,
           "the mission goes on by itself; waiting to be told to (autoContinue) is not supported");
  }
  switch (item.command) {
    case mav::kTakeoff:
      return take_off(item);
    case mav::kSplineWaypoint:
      remark(item, "it is flown to in a straight line");
      return fly_to(item, or_zero(item.params[0]), std::numeric_limits<double>::quiet_NaN());
    case mav::kWaypoint:
      if (or_zero(item.params[1]) != 0.0 || or_zero(item.params[2]) != 0.0) {
        remark(item, "the vehicle stops at each waypoint; radii to accept or pass it are not used");
      }
      return fly_to(item, or_zero(item.params[0]), item.yaw_deg());
    case mav::kLoiterUnlimited:
    case mav::kLoiterTurns:
    case mav::kLoiterTime:
      return loiter(item);
    case mav::kDelay:
      return hold(item, item.params[0]);
    case mav::kLand:
      return land(item);
    case mav::kReturnToLaunch:
      return add(item, Kind::kReturn);
    case mav::kChangeSpeed:
      return change_speed(item);
    case mav::kGripper:
      return move_claw(item);
    default:
      return remark(item, "not supported; left out");
  }
}

}  // namespace

void add_mavlink_items(const std::vector<MavlinkItem>& items, std::optional<double> home_altitude,
                       MissionFile& mission) {
  Import import(home_altitude, mission);
  for (const MavlinkItem& item : items) import.add(item);
}

}  // namespace swiftlet
