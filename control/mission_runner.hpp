// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "control/flight_director.hpp"
#include "control/mission.hpp"

namespace swiftlet {

/// What a claw is doing.
enum class ClawProgress { kUnknown, kMoving, kOpen, kClosed, kFault };

/// Flies a mission that was uploaded: gives its items to a FlightDirector, one after the other, and
/// waypoints of one kind in a row as one. It flies nothing itself, and all that it asks for can be
/// refused. Whatever else happens to the flight (a pilot, a policy, a plan that fails) pauses it,
/// with the reason that the director has; it goes on from there when it is told to.
class MissionRunner {
 public:
  enum class State {
    kNone,   ///< there is no mission
    kReady,  ///< not begun
    kFlying,
    kPaused,  ///< `item` was not finished
    kDone,
  };

  struct Params {
    double gps_altitude = 15.24;  ///< of waypoints on Earth that have none [m]
    double claw_timeout = 5.0;    ///< a claw that takes longer does not move [s]
    double claw_reaction = 0.5;   ///< until then it may tell of a fault that the command ends [s]
    std::size_t most_items = 1000;
  };

  /// All that it remembers beside the items. Another runner that is given this goes on.
  struct Memory {
    State state = State::kNone;
    std::size_t item = 0;               ///< index of the one that is flown, or was
    std::size_t run_end = 0;            ///< index behind the last that is flown as one with it
    std::optional<Time> waiting_since;  ///< for a hold to end, or for the claw
    std::string reason;                 ///< of kPaused
    std::optional<bool> claw_open;      ///< what the claw was told last
  };

  explicit MissionRunner(const Params& params) : params_(params) {}
  /// From the next item on.
  void set_params(const Params& params) { params_ = params; }
  MissionRunner() : MissionRunner(Params{}) {}

  /// Takes a mission in place of the one that there is. An error where one is being flown, or an
  /// item makes no sense: "item 3: a hold of -1 s cannot be flown".
  Status load(std::vector<MissionItem> items, const FlightDirector& director);
  /// An error where it is being flown.
  Status clear();

  /// Begins with an item, counted from 1; with 0 where it was paused, else with the first.
  Result<Acceptance> start(std::size_t item, FlightDirector& director,
                           const std::optional<LocalOrigin>& origin, Time now);
  /// Hovers, and keeps the place in it.
  Result<Acceptance> pause(FlightDirector& director, Time now);

  /// Once a tick, after the director's.
  void tick(FlightDirector& director, const std::optional<LocalOrigin>& origin, Time now);

  void set_claw(ClawProgress progress) { claw_ = progress; }
  /// Tells the claw by a command rather than by an item.
  void command_claw(bool open) { memory_.claw_open = open; }

  const std::vector<MissionItem>& items() const { return items_; }
  const Memory& memory() const { return memory_; }
  void restore(const Memory& memory, std::vector<MissionItem> items);

 private:
  using Kind = MissionItem::Kind;
  Result<Acceptance> begin(FlightDirector& director, const std::optional<LocalOrigin>& origin,
                           Time now);
  Result<Acceptance> fly_run(FlightDirector& director, const std::optional<LocalOrigin>& origin,
                             Time now);
  Result<Acceptance> fly_back(FlightDirector& director, Time now);
  std::size_t end_of_run(std::size_t first) const;
  bool is_finished(const FlightDirector::Status& status, Time now);
  bool goes_on(const FlightDirector::Status& status) const;
  std::string claw_problem(Time now) const;
  void interrupt(const std::string& reason);

  Params params_;
  std::vector<MissionItem> items_;
  Memory memory_;
  ClawProgress claw_ = ClawProgress::kUnknown;
};

const char* to_string(MissionRunner::State state);

}  // namespace swiftlet
