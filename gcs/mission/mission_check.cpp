// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/mission/mission_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "gcs/mission/fence_zones.hpp"
#include "gcs/mission/known_obstacles.hpp"
#include "gcs/mission/mission_track.hpp"

namespace swiftlet {
namespace {

using Kind = MissionItem::Kind;
using Severity = MissionFinding::Severity;
using About = MissionFinding::About;

constexpr double kLowestTakeoff = 0.3;  // below, the ground's cushion holds it [m]
constexpr double kSamePlace = 0.05;     // nearer counts as the same [m]

class Checker {
 public:
  Checker(const MissionFile& mission, const MissionCheckParams& params)
      : mission_(mission), params_(params), track_(track_of(mission, params)) {}

  MissionCheck check();

 private:
  void check_items();
  void check_order();
  void check_distances();
  void check_fence();
  void check_zones();
  void check_speeds();
  void check_obstacles();
  void check_battery();

  std::size_t count() const { return mission_.items.size(); }
  const MissionItem& item(std::size_t i) const { return mission_.items[i].item; }
  const MissionLeg& leg(std::size_t i) const { return track_.legs[i]; }
  void say(Severity severity, std::size_t i, std::string text) {
    result_.findings.push_back({severity, about_, i + 1, mission_.items[i].line, std::move(text)});
  }
  void say_of_all(Severity severity, std::string text) {
    result_.findings.push_back({severity, about_, 0, 0, std::move(text)});
  }

  const MissionFile& mission_;
  const MissionCheckParams& params_;
  const MissionTrack track_;
  MissionCheck result_;
  About about_ = About::kSize;
};

void Checker::check_items() {
  about_ = About::kItem;
  for (std::size_t i = 0; i < count(); ++i) {
    const std::string problem = problem_of(item(i));
    if (!problem.empty()) say(Severity::kError, i, problem + "; correct it");
    if (item(i).kind == Kind::kTakeoff && item(i).altitude < kLowestTakeoff) {
      say(Severity::kError, i,
          fmt::format("a take-off to {} m does not leave the ground; climb to {} m or more",
                      item(i).altitude, kLowestTakeoff));
    }
  }
}

void Checker::check_order() {
  about_ = About::kOrder;
  bool flies = !params_.on_ground, has_landed = false, has_said = false;
  for (std::size_t i = 0; i < count(); ++i) {
    const Kind kind = item(i).kind;
    if (kind == Kind::kClaw) continue;
    if (kind == Kind::kTakeoff) {
      if (!flies && has_landed) {
        say(Severity::kWarning, i,
            "the vehicle disarms when it has landed, so that the mission pauses here until it is "
            "armed and told to go on; make two missions of it");
      }
      flies = true;
      continue;
    }
    if (!flies && !has_said) {
      has_said = true;  // all that follow have the same reason
      say(Severity::kError, i,
          has_landed
              ? "it stands behind the landing, and needs flight; put a take-off before it, or "
                "leave it out"
              : "it needs flight, and the vehicle is on the ground; begin with a take-off");
    }
    if (kind == Kind::kLand || kind == Kind::kReturn) {
      flies = false;
      has_landed = true;
      has_said = false;
    }
  }
  if (flies && count() > 0) {
    say_of_all(Severity::kWarning,
               "it ends in the air, and the vehicle hovers there; end with a return or a landing");
  }
}

void Checker::check_distances() {
  about_ = About::kDistance;
  bool has_waypoint = false;
  for (std::size_t i = 0; i < count(); ++i) {
    if (item(i).kind != Kind::kWaypoint) continue;
    if (leg(i).is_known && leg(i).length > params_.longest_leg) {
      say(Severity::kError, i,
          fmt::format("it is {:.0f} m from the place before, farther than {:.0f} m; is a sign "
                      "wrong, or are "
                      "latitude and longitude swapped?",
                      leg(i).length, params_.longest_leg));
    }
    const bool is_idle = leg(i).is_known && has_waypoint && leg(i).length < kSamePlace &&
                         !item(i).place.yaw && item(i).hold == 0.0;
    if (is_idle) {
      say(Severity::kWarning, i,
          fmt::format("it is {:.2f} m from the place before, and does nothing there; leave it out",
                      leg(i).length));
    }
    if (!leg(i).is_known && leg(i).has_begin) {
      say(Severity::kWarning, i,
          "nobody says where the map is on Earth, so that the way to it is not checked; give "
          "'home'");
    }
    has_waypoint = true;
  }
}

void Checker::check_fence() {
  about_ = About::kFence;
  const Geofence& fence = params_.fence;
  for (std::size_t i = 0; i < count(); ++i) {
    const MissionItem& what = item(i);
    const double height = leg(i).to.z() - params_.takeoff.z();
    const bool goes_up = what.kind == Kind::kWaypoint || what.kind == Kind::kTakeoff;
    if (goes_up && fence.height > 0.0 && height > fence.height) {
      say(Severity::kError, i,
          fmt::format(
              "it is at {:.1f} m, {:.1f} m above the fence of {:.1f} m; lower it, or raise the "
              "fence",
              height, height - fence.height, fence.height));
    }
    if (what.kind != Kind::kWaypoint || !(fence.radius > 0.0)) continue;
    if (!leg(i).in_map) continue;
    const double distance = (leg(i).to - params_.takeoff).head<2>().norm();
    if (distance > fence.radius) {
      say(Severity::kError, i,
          fmt::format(
              "it is {:.1f} m from the take-off point, {:.1f} m outside of the fence of {:.1f} "
              "m; move it, or widen the fence",
              distance, distance - fence.radius, fence.radius));
    }
  }
  const bool is_unknown = std::any_of(track_.legs.begin(), track_.legs.end(),
                                      [](const MissionLeg& leg) { return !leg.in_map; });
  if (fence.radius > 0.0 && is_unknown) {
    say_of_all(
        Severity::kWarning,
        "nobody says where it takes off on Earth, so that the fence's radius is not checked; "
        "give 'home'");
  }
}

void Checker::check_zones() {
  about_ = About::kZone;
  if (mission_.fence.empty() || !track_.origin) return;
  const FenceZones zones(mission_.fence, *track_.origin);
  for (std::size_t i = 0; i < count(); ++i) {
    if (!leg(i).flies || leg(i).in_map != track_.is_of_map) continue;
    const Eigen::Vector2d to = leg(i).to.head<2>();
    const bool whole_way = leg(i).is_known && leg(i).is_straight;
    const Eigen::Vector2d from = whole_way ? Eigen::Vector2d(leg(i).from.head<2>()) : to;
    const std::string problem = zones.problem_of_way(from, to);
    if (!problem.empty()) {
      say(Severity::kError, i,
          fmt::format("{}, by the fence of the mission; move it, or the fence", problem));
    }
  }
}

void Checker::check_speeds() {
  about_ = About::kSpeed;
  for (std::size_t i = 0; i < count(); ++i) {
    const std::optional<double> speed = item(i).place.speed;
    if (item(i).kind != Kind::kWaypoint || !speed) continue;
    if (params_.most_speed && *speed > *params_.most_speed) {
      say(Severity::kError, i,
          fmt::format("its speed of {} m/s is above the limit of {} m/s; lower it", *speed,
                      *params_.most_speed));
    } else if (params_.flown_speed && *speed > *params_.flown_speed) {
      say(Severity::kWarning, i,
          fmt::format("its speed of {} m/s is above what the vehicle flies, and will be {} m/s",
                      *speed, *params_.flown_speed));
    }
  }
}

void Checker::check_obstacles() {
  about_ = About::kObstacle;
  if (params_.map == nullptr || params_.map->empty()) return;
  const KnownObstacles obstacles(*params_.map, params_.clearance);
  for (std::size_t i = 0; i < count(); ++i) {
    if (!leg(i).flies || !leg(i).in_map || !obstacles.covers(leg(i).to.z())) continue;
    const Eigen::Vector2d to = leg(i).to.head<2>();
    if (const std::string problem = obstacles.problem_at(to); !problem.empty()) {
      say(Severity::kError, i,
          fmt::format("x {:.2f}, y {:.2f} {}; move it", to.x(), to.y(), problem));
      continue;
    }
    if (!obstacles.knows(to)) {
      say(Severity::kWarning, i,
          fmt::format("x {:.2f}, y {:.2f} is not known in the map; expect a way around, or none",
                      to.x(), to.y()));
    }
    if (!leg(i).is_straight || !leg(i).is_known) continue;
    const std::string problem = obstacles.problem_on(leg(i).from.head<2>(), to);
    if (!problem.empty()) {
      say(Severity::kError, i,
          fmt::format("its straight way is not clear: {}; put a waypoint beside it, or fly higher",
                      problem));
    }
  }
}

void Checker::check_battery() {
  about_ = About::kBattery;
  const double available =
      params_.endurance.value_or(0.0) * std::max(0.0, params_.charge - params_.reserve);
  double elapsed = 0.0;
  bool cannot_return = false;
  for (std::size_t i = 0; i < count(); ++i) {
    elapsed += leg(i).duration;
    if (!params_.endurance) continue;
    if (elapsed > available && elapsed - leg(i).duration <= available) {
      say(Severity::kError, i,
          fmt::format(
              "it ends after {:.0f} s, and the battery lasts {:.0f} s down to its reserve of "
              "{:.0f} %; shorten the mission, or make two of it",
              elapsed, available, 100.0 * params_.reserve));
      cannot_return = true;
    } else if (!cannot_return && elapsed + leg(i).way_home > available) {
      cannot_return = true;
      say(Severity::kWarning, i,
          fmt::format(
              "from here it cannot come home: {:.0f} s are flown, {:.0f} s it takes, and the "
              "battery lasts {:.0f} s down to its reserve of {:.0f} %",
              elapsed, leg(i).way_home, available, 100.0 * params_.reserve));
    }
  }
  // What ends in the air has to come home yet.
  result_.duration = elapsed + (track_.legs.empty() ? 0.0 : track_.legs.back().way_home);
  for (const MissionLeg& leg : track_.legs) result_.length += leg.length;
}

MissionCheck Checker::check() {
  if (count() == 0) say_of_all(Severity::kError, "there are no items; add at least one");
  if (count() > params_.most_items) {
    say_of_all(Severity::kError,
               fmt::format("it has {} items, and the vehicle takes {}; make several missions of it",
                           count(), params_.most_items));
  }
  check_items();
  check_order();
  check_distances();
  check_fence();
  check_zones();
  check_speeds();
  check_obstacles();
  check_battery();
  const auto place = [](const MissionFinding& finding) { return finding.item - 1; };  // 0 last
  std::stable_sort(
      result_.findings.begin(), result_.findings.end(),
      [&](const MissionFinding& a, const MissionFinding& b) { return place(a) < place(b); });
  return std::move(result_);
}

}  // namespace

bool MissionCheck::has_errors() const {
  return std::any_of(findings.begin(), findings.end(), [](const MissionFinding& finding) {
    return finding.severity == Severity::kError;
  });
}

MissionCheck check_mission(const MissionFile& mission, const MissionCheckParams& params) {
  return Checker(mission, params).check();
}

MissionCheck check_change(const MissionFile& before, const MissionFile& after,
                          const MissionCheckParams& params) {
  MissionCheck check = check_mission(after, params);
  std::vector<MissionFinding> known;
  for (MissionFinding& finding : check_mission(before, params).findings) {
    if (finding.severity == Severity::kError) known.push_back(std::move(finding));
  }
  const auto forgive = [&](auto is_same) {
    for (MissionFinding& finding : check.findings) {
      if (finding.severity != Severity::kError) continue;
      const auto same = std::find_if(known.begin(), known.end(), [&](const MissionFinding& old) {
        return is_same(old, finding);
      });
      if (same == known.end()) continue;
      finding.severity = Severity::kWarning;
      known.erase(same);
    }
  };
  forgive([](const auto& old, const auto& now) { return old.text == now.text; });
  forgive([](const auto& old, const auto& now) { return old.about == now.about; });
  return check;
}

std::string describe(const MissionFinding& finding, const std::string& file) {
  std::string text = file;
  if (finding.line > 0) text += fmt::format(":{}", finding.line);
  if (finding.item > 0) text += fmt::format(": item {}", finding.item);
  return text + (finding.severity == Severity::kError ? ": error: " : ": warning: ") + finding.text;
}

}  // namespace swiftlet
