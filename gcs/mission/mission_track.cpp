// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/mission/mission_track.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet {
namespace {

using Kind = MissionItem::Kind;

/// The map where its point `takeoff` is at `home`. Heights of missions are above that.
LocalOrigin origin_with(const GlobalPosition& home, const Eigen::Vector3d& takeoff) {
  const LocalOrigin at_home({home.latitude, home.longitude, 0.0});
  GlobalPosition origin = at_home.to_global({-takeoff.x(), -takeoff.y(), 0.0});
  origin.altitude = 0.0;
  return LocalOrigin(origin);
}

void choose_origin(const MissionFile& mission, const MissionCheckParams& params,
                   MissionTrack& track) {
  track.is_of_map = params.origin || mission.home;
  if (params.origin) {
    track.origin = params.origin;
  } else if (mission.home) {
    track.origin = origin_with(*mission.home, params.takeoff);
  } else {
    for (const WrittenItem& written : mission.items) {
      const auto& place = written.item.global;
      if (!place) continue;
      track.origin = LocalOrigin({place->latitude, place->longitude, 0.0});
      return;
    }
  }
}

/// From rest to rest, with as much acceleration as braking [s].
double time_for(double distance, double speed, double acceleration) {
  const double ramps = speed * speed / acceleration;
  return distance >= ramps ? distance / speed + speed / acceleration
                           : 2.0 * std::sqrt(distance / acceleration);
}

/// Goes along the mission, item by item.
class Tracker {
 public:
  Tracker(const MissionFile& mission, const MissionCheckParams& params, MissionTrack& track)
      : mission_(mission),
        params_(params),
        track_(track),
        at_(params.on_ground ? params.takeoff : params.start.value_or(params.takeoff)),
        is_flying_(!params.on_ground),
        is_somewhere_(params.on_ground || params.start) {}

  void add(const MissionItem& item);

 private:
  void take_off(const MissionItem& item, MissionLeg& leg);
  void fly_to(const MissionItem& item, MissionLeg& leg);
  void fly_back(MissionLeg& leg);
  void land(MissionLeg& leg);
  double leg_time(const MissionLeg& leg, double speed) const;
  double way_home() const;

  const MissionFile& mission_;
  const MissionCheckParams& params_;
  MissionTrack& track_;
  Eigen::Vector3d at_;
  bool in_map_ = true;
  bool is_flying_;
  bool is_somewhere_;  // `at_` is known
  bool is_guided_by_gps_ = false;
  double speed_ = 0.0;  // of the last waypoint [m/s]
};

void Tracker::take_off(const MissionItem& item, MissionLeg& leg) {
  if (is_flying_) return;
  is_flying_ = true;
  at_.z() = params_.takeoff.z() + item.altitude;
  leg.duration = item.altitude / params_.climb_speed;
}

/// At first to the height of the end, then level.
double Tracker::leg_time(const MissionLeg& leg, double speed) const {
  const double way = (leg.to - leg.from).head<2>().norm();
  const double climb = std::abs(leg.to.z() - leg.from.z());
  return time_for(way, speed, params_.acceleration) +
         time_for(climb, std::min(params_.climb_speed, speed), params_.acceleration);
}

void Tracker::fly_to(const MissionItem& item, MissionLeg& leg) {
  leg.flies = true;
  leg.is_straight = is_guided_by_gps_ = item.global.has_value();
  const bool was_in_map = in_map_;
  speed_ = params_.indoor_speed;
  if (item.global && track_.origin) {
    const auto place =
        place_of(*item.global, *track_.origin, params_.gps_altitude, params_.takeoff.z());
    if (place.ok()) at_ = *place;  // else problem_of has said it
    in_map_ = track_.is_of_map;
    speed_ = item.place.speed.value_or(mission_.cruise_speed.value_or(params_.gps_speed));
    if (params_.flown_speed) speed_ = std::min(speed_, *params_.flown_speed);
  } else {
    at_ = item.place.position;
    in_map_ = true;
  }
  leg.to = at_;
  leg.in_map = in_map_;
  leg.has_begin = is_somewhere_;
  leg.is_known = is_somewhere_ && was_in_map == in_map_;
  is_somewhere_ = true;
  if (leg.is_known) {
    leg.length = (leg.to - leg.from).norm();
    leg.duration = leg_time(leg, speed_);
  }
  leg.duration += item.hold;
}

void Tracker::fly_back(MissionLeg& leg) {
  leg.flies = true;
  leg.is_straight = is_guided_by_gps_;
  leg.has_begin = is_somewhere_;
  leg.is_known = is_somewhere_ && in_map_;
  is_somewhere_ = true;
  at_.head<2>() = params_.takeoff.head<2>();
  in_map_ = true;
  leg.to = at_;
  if (leg.is_known) {
    leg.length = (leg.to - leg.from).norm();
    leg.duration = leg_time(leg, speed_ > 0.0 ? speed_ : params_.indoor_speed);
  }
  land(leg);
}

void Tracker::land(MissionLeg& leg) {
  leg.duration += std::max(0.0, at_.z() - params_.takeoff.z()) / params_.descent_speed;
  at_.z() = params_.takeoff.z();
  is_flying_ = false;
}

double Tracker::way_home() const {
  if (!is_flying_) return 0.0;
  const double down = std::max(0.0, at_.z() - params_.takeoff.z()) / params_.descent_speed;
  if (!in_map_) return down;
  const double way = (at_ - params_.takeoff).head<2>().norm();
  const double speed = is_guided_by_gps_ ? params_.gps_speed : params_.indoor_speed;
  return time_for(way, speed, params_.acceleration) + down;
}

void Tracker::add(const MissionItem& item) {
  MissionLeg leg;
  leg.from = leg.to = at_;
  leg.in_map = in_map_;
  switch (item.kind) {
    case Kind::kTakeoff:
      take_off(item, leg);
      break;
    case Kind::kWaypoint:
      fly_to(item, leg);
      break;
    case Kind::kHold:
      leg.duration = item.hold;
      break;
    case Kind::kLand:
      land(leg);
      break;
    case Kind::kReturn:
      fly_back(leg);
      break;
    case Kind::kClaw:
      leg.duration = params_.claw_time;
      break;
  }
  if (!leg.flies) leg.to = at_;
  leg.way_home = way_home();
  track_.legs.push_back(leg);
}

}  // namespace

MissionTrack track_of(const MissionFile& mission, const MissionCheckParams& params) {
  MissionTrack track;
  choose_origin(mission, params, track);
  Tracker tracker(mission, params, track);
  for (const WrittenItem& written : mission.items) tracker.add(written.item);
  return track;
}

}  // namespace swiftlet
