// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimation/battery/battery_clock.hpp"
#include "gcs/screen/drawing/map_picture.hpp"
#include "gcs/screen/state/event_log.hpp"
#include "gcs/screen/state/heard.hpp"
#include "gcs/screen/state/vehicle_reports.hpp"

namespace swiftlet::screen {

/// The command that was given last, and what became of it.
struct CommandNote {
  std::string text;
  Severity severity = Severity::kNote;
};

/// All that a ground station knows of a vehicle, from what it hears and when. Knows no middleware,
/// no clock, and no screen. What happens is noted in the log. Its memory is bounded.
class GroundStationModel {
 public:
  static constexpr std::size_t kLongestTrail = 2000;
  static constexpr double kTrailStep = 0.1;  ///< [m]
  /// What a component lacks is noted when it lasts.
  static constexpr Duration kLasting = std::chrono::milliseconds(500);
  /// Batteries speak up to once a second, and missions that do not change twice.
  static constexpr Duration kBatteryStale = std::chrono::milliseconds(2500);
  static constexpr Duration kMissionStale = std::chrono::milliseconds(2500);

  void hear(const VehicleReport& report, Time now);
  void hear(const RigidBodyState& state, Time now);
  void hear(const BatteryReport& report, Time now);
  /// Nothing: a receiver without a fix.
  void hear(const std::optional<GlobalFix>& fix, Time now);
  void hear(const MissionReport& report, Time now);
  void hear(const ClawReport& report, Time now);
  void hear(const GuardReport& report, Time now);
  void hear(const LimitsReport& report, Time now) { limits_.hear(report, now); }
  void hear(const LinkReport& report, Time now);
  /// What is heard of it first-hand wins.
  void hear(const TelemetryReport& report, Time now);
  void hear_component(const std::string& name, const ComponentReport& report, Time now);
  void hear_map(std::shared_ptr<const GridMap> map, Time now);
  void hear_path(std::vector<Eigen::Vector2d> path, Time now);
  /// Notes what has fallen silent. Many times a second.
  void tick(Time now);

  void note(Time now, Severity severity, const std::string& text) { log_.add(now, severity, text); }
  void set_command(CommandNote note) { command_ = std::move(note); }
  void set_station(const std::string& name) { station_ = name; }

  /// The name of this ground station; "" where it has none.
  const std::string& station() const { return station_; }
  bool has_control() const {
    return vehicle_.known() && !station_.empty() && vehicle_->station == station_;
  }
  const Heard<VehicleReport>& vehicle() const { return vehicle_; }
  const Heard<RigidBodyState>& pose() const { return pose_; }
  const Heard<BatteryReport>& battery() const { return battery_; }
  std::optional<double> battery_seconds_left(Time now) const;
  const Heard<std::optional<GlobalFix>>& fix() const { return fix_; }
  /// Where the map is on Earth; nothing while that is not known well.
  std::optional<LocalOrigin> origin() const { return origin_.origin(); }
  const Heard<MissionReport>& mission() const { return mission_; }
  bool mission_flies() const {
    return mission_.known() && mission_->state == MissionReport::State::kFlying;
  }
  const Heard<ClawReport>& claw() const { return claw_; }
  const Heard<LimitsReport>& limits() const { return limits_; }
  const Heard<GuardReport>& guard() const { return guard_; }
  const Heard<LinkReport>& link() const { return link_; }
  const Heard<TelemetryReport>& telemetry() const { return telemetry_; }
  /// Whether the vehicle is known by telemetry alone.
  bool lives_on_telemetry(Time now) const {
    return telemetry_.fresh(now) && first_hand_.vehicle.silent(now);
  }
  const std::map<std::string, Heard<ComponentReport>>& components() const { return components_; }
  const std::shared_ptr<const GridMap>& map() const { return map_; }
  /// Of what is known of the map.
  const std::optional<Extent>& map_extent() const { return extent_; }
  const Heard<std::vector<Eigen::Vector2d>>& path() const { return path_; }
  const std::deque<Eigen::Vector2d>& trail() const { return trail_; }
  const EventLog& log() const { return log_; }
  const CommandNote& command() const { return command_; }
  /// Reports of the vehicle in the last second.
  int reports_per_s(Time now) const;
  /// What is wrong right now, the worst first; empty where all is well.
  std::vector<std::string> problems(Time now) const;

 private:
  void look_at(const std::string& name, const Heard<ComponentReport>& component, Time now);
  void take(const VehicleReport& report, Time now);
  void take(const RigidBodyState& state, Time now);
  void take(const BatteryReport& report, Time now);
  void take(const std::optional<GlobalFix>& fix, Time now);
  void take(const MissionReport& report, Time now);
  void take(const ClawReport& report, Time now);
  void take(const GuardReport& report, Time now);
  void note_changes(const VehicleReport& before, const VehicleReport& after, Time now);
  void note_progress(const VehicleReport& before, const VehicleReport& after, Time now);
  void note_changes(const MissionReport& before, const MissionReport& after, Time now);

  Heard<VehicleReport> vehicle_;
  Heard<RigidBodyState> pose_;
  Heard<BatteryReport> battery_{kBatteryStale};
  BatteryClock battery_clock_;
  Heard<std::optional<GlobalFix>> fix_;
  OriginEstimate origin_;
  Heard<MissionReport> mission_{kMissionStale};
  Time mission_flew_{};  // last
  Heard<LimitsReport> limits_;
  Heard<ClawReport> claw_;
  Heard<GuardReport> guard_;
  Heard<LinkReport> link_{kBatteryStale};
  Heard<TelemetryReport> telemetry_;
  struct {
    FirstHand vehicle, pose, fix, claw, guard;
    FirstHand battery{std::chrono::seconds(2)}, mission{std::chrono::seconds(2)};
  } first_hand_;
  std::map<std::string, Heard<ComponentReport>> components_;
  struct Problem {
    std::string text;    // "" where it is well
    Time since{};        //
    bool noted = false;  // in the log
  };
  std::map<std::string, Problem> component_problems_;
  std::shared_ptr<const GridMap> map_;
  std::optional<Extent> extent_;
  Heard<std::vector<Eigen::Vector2d>> path_;
  std::deque<Eigen::Vector2d> trail_;
  std::deque<Time> reports_;
  EventLog log_;
  CommandNote command_;
  std::string station_;
  bool link_lost_ = false;
};

}  // namespace swiftlet::screen
