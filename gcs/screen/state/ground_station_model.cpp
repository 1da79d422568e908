// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/state/ground_station_model.hpp"

#include <fmt/format.h>

namespace swiftlet::screen {
namespace {

/// Who was not heard for so long has left [s].
constexpr double kGone = 10.0;

struct Threshold {
  double percentage;
  Severity severity;
};
/// What telemetry has instead of what components say; "" where all is well.
std::string describe(TelemetryReport::Health health) {
  switch (health) {
    case TelemetryReport::Health::kWell:
      return "";
    case TelemetryReport::Health::kWarned:
      return "on board: a warning";
    case TelemetryReport::Health::kError:
      return "on board: an error";
    case TelemetryReport::Health::kUnknown:
      return "on board: somebody is silent";
  }
  return "";
}

constexpr Threshold kBatteryThresholds[] = {
    {0.1, Severity::kDanger}, {0.2, Severity::kDanger}, {0.3, Severity::kCaution}};

}  // namespace

std::string describe_pause(const MissionReport& report) {
  const std::string where = fmt::format("mission paused at item {}", report.item);
  return report.reason.empty() ? where : where + ": " + report.reason;
}

void GroundStationModel::hear(const VehicleReport& report, Time now) {
  first_hand_.vehicle.hear(now);
  take(report, now);
}

void GroundStationModel::take(const VehicleReport& report, Time now) {
  if (!vehicle_.known()) {
    log_.add(now, Severity::kSuccess, "vehicle heard: " + report.mode);
  } else {
    if (link_lost_) {
      log_.add(now, Severity::kSuccess,
               fmt::format("link is back after {:.1f} s", to_seconds(vehicle_.age(now))));
    }
    note_changes(*vehicle_, report, now);
  }
  link_lost_ = false;
  vehicle_.hear(report, now);
  reports_.push_back(now);
  while (now - reports_.front() > kStale) reports_.pop_front();
}

void GroundStationModel::note_changes(const VehicleReport& before, const VehicleReport& after,
                                      Time now) {
  if (before.armed != after.armed) {
    log_.add(now, after.armed ? Severity::kCaution : Severity::kNote,
             after.armed ? "armed" : "disarmed");
  }
  if (before.mode != after.mode) {
    const std::string why = after.reason.empty() ? "" : ": " + after.reason;
    log_.add(now, Severity::kNote, fmt::format("{} → {}{}", before.mode, after.mode, why));
  } else if (before.reason != after.reason && !after.reason.empty()) {
    log_.add(now, Severity::kCaution, after.reason);
  } else if (!before.ready && after.ready && !after.armed) {
    log_.add(now, Severity::kSuccess, "ready");
  }
  if (before.station != after.station) {
    log_.add(now, after.station == station_ ? Severity::kSuccess : Severity::kCaution,
             after.station.empty() ? "control: no station has it"
                                   : "control: " + after.station + " has it");
  }
  note_progress(before, after, now);
}

/// Of a goto and its like. Items of a mission are its own to tell.
void GroundStationModel::note_progress(const VehicleReport& before, const VehicleReport& after,
                                       Time now) {
  if (now - mission_flew_ < kStale) return;
  if (after.waypoint != before.waypoint && after.waypoint > 1 && !after.mission_done) {
    log_.add(now, Severity::kNote,
             fmt::format("waypoint {} of {}", after.waypoint, after.waypoint_count));
  }
  if (!before.mission_done && after.mission_done) {
    log_.add(now, Severity::kSuccess, "mission done");
  }
}

void GroundStationModel::hear(const RigidBodyState& state, Time now) {
  first_hand_.pose.hear(now);
  take(state, now);
}

void GroundStationModel::take(const RigidBodyState& state, Time now) {
  pose_.hear(state, now);
  const Eigen::Vector2d place = state.p_WB.head<2>();
  if (!place.allFinite()) return;
  if (!trail_.empty() && (place - trail_.back()).norm() < kTrailStep) return;
  trail_.push_back(place);
  if (trail_.size() > kLongestTrail) trail_.pop_front();
}

void GroundStationModel::hear(const BatteryReport& report, Time now) {
  first_hand_.battery.hear(now);
  take(report, now);
}

void GroundStationModel::take(const BatteryReport& report, Time now) {
  if (battery_.known()) {
    for (const Threshold& threshold : kBatteryThresholds) {
      if (battery_->percentage <= threshold.percentage ||
          report.percentage > threshold.percentage) {
        continue;
      }
      log_.add(now, threshold.severity,
               fmt::format("battery below {:.0f} %", threshold.percentage * 100.0));
      break;
    }
  }
  battery_.hear(report, now);
  battery_clock_.add(report, now);
}

void GroundStationModel::hear(const std::optional<GlobalFix>& fix, Time now) {
  first_hand_.fix.hear(now);
  take(fix, now);
}

void GroundStationModel::take(const std::optional<GlobalFix>& fix, Time now) {
  fix_.hear(fix, now);
  if (fix && pose_.fresh(now)) origin_.add(fix->position, fix->sigma, pose_->p_WB);
}

void GroundStationModel::hear(const MissionReport& report, Time now) {
  first_hand_.mission.hear(now);
  take(report, now);
}

void GroundStationModel::take(const MissionReport& report, Time now) {
  note_changes(mission_.known() ? *mission_ : MissionReport{}, report, now);
  mission_.hear(report, now);
  if (mission_flies()) mission_flew_ = now;
}

void GroundStationModel::note_changes(const MissionReport& before, const MissionReport& after,
                                      Time now) {
  using State = MissionReport::State;
  // What was refused before anybody looked is no news.
  if (mission_.known() && !after.refusal.empty() &&
      (after.refusal != before.refusal || after.upload != before.upload)) {
    log_.add(now, Severity::kDanger, after.refusal);
  }
  if (after.id != before.id || after.count != before.count) {
    const std::string what =
        mission_.known() ? "mission of {} items uploaded" : "the vehicle has a mission of {} items";
    log_.add(now, Severity::kNote,
             after.count > 0 ? fmt::format(fmt::runtime(what), after.count) : "mission cleared");
  }
  if (after.state == before.state) {
    if (after.state == State::kFlying && after.item != before.item) {
      log_.add(now, Severity::kNote,
               fmt::format("mission: item {} of {}", after.item, after.count));
    }
  } else if (after.state == State::kFlying) {
    log_.add(now, Severity::kNote,
             fmt::format("mission: flies from item {} of {}", after.item, after.count));
  } else if (after.state == State::kPaused) {
    log_.add(now, Severity::kCaution, describe_pause(after));
  } else if (after.state == State::kDone) {
    log_.add(now, Severity::kSuccess, fmt::format("mission: all {} items done", after.count));
  }
}

void GroundStationModel::hear(const ClawReport& report, Time now) {
  first_hand_.claw.hear(now);
  take(report, now);
}

void GroundStationModel::take(const ClawReport& report, Time now) {
  const std::string before = claw_.known() ? claw_->fault : "";
  if (report.fault != before && !report.fault.empty()) {
    log_.add(now, Severity::kDanger, "claw: " + report.fault);
  }
  claw_.hear(report, now);
}

void GroundStationModel::hear(const GuardReport& report, Time now) {
  first_hand_.guard.hear(now);
  take(report, now);
}

void GroundStationModel::take(const GuardReport& report, Time now) {
  const bool acted = guard_.known() && guard_->acting;
  if (report.acting && !acted) log_.add(now, Severity::kDanger, "guard acts: " + report.reason);
  if (!report.acting && acted) log_.add(now, Severity::kNote, "guard lets go");
  guard_.hear(report, now);
}

void GroundStationModel::hear(const LinkReport& report, Time now) {
  link_.hear(report, now);
}

void GroundStationModel::hear(const TelemetryReport& report, Time now) {
  telemetry_.hear(report, now);
  const auto silent = [now](const FirstHand& source) { return source.silent(now); };
  if (report.vehicle && silent(first_hand_.vehicle)) take(*report.vehicle, now);
  if (report.pose && silent(first_hand_.pose)) take(*report.pose, now);
  if (report.battery && silent(first_hand_.battery)) take(*report.battery, now);
  if (report.fix && silent(first_hand_.fix)) take(report.fix, now);
  if (report.claw && silent(first_hand_.claw)) take(*report.claw, now);
  if (silent(first_hand_.guard)) take(report.guard, now);
  if (!report.vehicle || !silent(first_hand_.mission)) return;
  using State = MissionReport::State;
  MissionReport mission = report.mission;
  if (mission_.known()) {  // what telemetry leaves out is as it was
    mission.id = mission_->id;
    mission.refusal = mission_->refusal;
    mission.upload = mission_->upload;
  }
  const bool flew = mission_.known() && mission_->count == mission.count &&
                    (mission_->state == State::kFlying || mission_->state == State::kDone);
  if (mission.state == State::kReady && flew) mission.state = State::kDone;
  take(mission, now);
}

std::optional<double> GroundStationModel::battery_seconds_left(Time now) const {
  // On board it is known from more than what comes down.
  if (telemetry_.fresh(now) && first_hand_.battery.silent(now)) {
    return telemetry_->battery_seconds_left;
  }
  return battery_clock_.seconds_left(now);
}

void GroundStationModel::hear_component(const std::string& name, const ComponentReport& report,
                                        Time now) {
  components_[name].hear(report, now);
}

void GroundStationModel::hear_map(std::shared_ptr<const GridMap> map, Time) {
  map_ = std::move(map);
  extent_ = known_extent(*map_);
}

void GroundStationModel::hear_path(std::vector<Eigen::Vector2d> path, Time now) {
  path_.hear(std::move(path), now);
}

void GroundStationModel::tick(Time now) {
  if (vehicle_.known() && !vehicle_.fresh(now) && !link_lost_) {
    link_lost_ = true;
    log_.add(now, Severity::kDanger, "link lost: nothing heard for 1 s");
  }
  // While nothing comes from the vehicle, nobody on board is to blame.
  if (!vehicle_.fresh(now)) return;
  for (auto component = components_.begin(); component != components_.end();) {
    const auto& [name, heard] = *component;
    if (to_seconds(heard.age(now)) > kGone && !vehicle_->in_flight) {
      component_problems_.erase(name);
      component = components_.erase(component);
      continue;
    }
    look_at(name, heard, now);
    ++component;
  }
}

void GroundStationModel::look_at(const std::string& name, const Heard<ComponentReport>& component,
                                 Time now) {
  std::string text;
  if (!component->problems.empty()) text = component->problems.front();
  if (!component.fresh(now)) text = "silent; does its process live?";
  Problem& problem = component_problems_[name];
  if (text.empty()) {
    if (problem.noted) log_.add(now, Severity::kSuccess, name + ": well again");
    problem = {};
    return;
  }
  if (problem.text.empty()) problem.since = now;
  problem.text = text;
  if (problem.noted || now - problem.since < kLasting) return;
  problem.noted = true;
  log_.add(now, Severity::kCaution, name + ": " + text);
}

int GroundStationModel::reports_per_s(Time now) const {
  int count = 0;
  for (const Time time : reports_) count += now - time <= kStale ? 1 : 0;
  return count;
}

std::vector<std::string> GroundStationModel::problems(Time now) const {
  std::vector<std::string> problems;
  if (guard_.fresh(now) && guard_->acting) problems.push_back("guard: " + guard_->reason);
  if (claw_.fresh(now) && !claw_->fault.empty()) problems.push_back("claw: " + claw_->fault);
  if (vehicle_.known() && !vehicle_->ready && !vehicle_->armed && !vehicle_->reason.empty()) {
    problems.push_back(vehicle_->reason);
  }
  if (lives_on_telemetry(now)) {
    const std::string health = describe(telemetry_->health);
    if (!health.empty()) problems.push_back(health);
  }
  for (const auto& [name, problem] : component_problems_) {
    if (problem.text.empty()) continue;
    // The vehicle may have said the same as why it is not ready.
    const std::string text = name + ": " + problem.text;
    if (problems.empty() || problems.back().find(name) == std::string::npos) {
      problems.push_back(text);
    }
  }
  return problems;
}

}  // namespace swiftlet::screen
