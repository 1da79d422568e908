// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>

#include "gcs/mission/mission_file.hpp"
#include "gcs/screen/state/event_log.hpp"

namespace swiftlet::screen {

/// What a person asked for by keys.
struct Action {
  enum class Kind {
    kArm,
    kDisarm,
    kTakeoff,
    kLand,
    kHover,
    kReturn,
    kExplore,
    kManual,
    kAssist,
    kGoTo,
    kGoToGlobal,
    kFlyMission,    ///< bring `mission` to the vehicle, and start it
    kPauseMission,  ///< hover, and keep the place in it
    kGoOn,          ///< with the vehicle's mission
    kClearMission,  ///< the vehicle's
    kFetchMission,  ///< the vehicle's, into the list
    kSave,
    kLoad,
    kOpenClaw,
    kCloseClaw,
    kTakeControl,
    kGiveControl,     ///< to `name`
    kReleaseControl,  ///< to whoever commands next
    kListParameters,
    kSetParameter,
    kNote,  ///< into the log alone
    kTell,  ///< to who sits there, and into the log
    kQuit,
  };
  Kind kind = Kind::kHover;
  double altitude = 0.0;                            ///< kTakeoff: above the take-off point [m]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< kGoTo: in the map [m]
  GlobalWaypoint global{};                          ///< kGoToGlobal
  MissionFile mission{};                            ///< kFlyMission
  std::string file{};                               ///< kSave, kLoad
  bool replaces = false;                            ///< kSave: what has that name, unasked
  std::string component{};                          ///< of parameters
  std::string name{};                               ///< of a parameter, or a station
  std::string value{};                              ///< kSetParameter, as in YAML
  std::string text{};                               ///< kNote, kTell
  Severity severity = Severity::kNote;              ///< kNote, kTell
};

inline Action action(Action::Kind kind) {
  Action action;
  action.kind = kind;
  return action;
}

/// kNote or kTell.
inline Action message(Action::Kind kind, Severity severity, const std::string& text) {
  Action message = action(kind);
  message.severity = severity;
  message.text = text;
  return message;
}

}  // namespace swiftlet::screen
