// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "components/commander/mission_inbox.hpp"
#include "gcs/command/ground_options.hpp"
#include "gcs/mission/mission_file.hpp"

/// Missions between files and the vehicle, for the verbs that do so. Whatever fails ends the verb
/// (end_verb) with its reason.
namespace swiftlet {

/// `--patience`, of every transfer.
void add_patience(CLI::App& verb, double& patience_s);

/// The mission of a file; remarks go to the error stream.
MissionFile mission_of_file(const std::string& file);

/// Where and when a mission will be flown.
enum class MissionBegin {
  kNow,        ///< from where the vehicle is, with the battery that it has
  kLater,      ///< from where the vehicle stands, or took off
  kElsewhere,  ///< from another place: what depends on places is not checked
};

struct UploadPlan {
  MissionBegin begin = MissionBegin::kLater;
  double patience = 20.0;                    ///< for the vehicle to be heard [s]
  const MissionFile* in_place_of = nullptr;  ///< what it has in common with that may be wrong
};

/// Its items, where the vehicle can fly it by all that it says of itself and of the place; what was
/// found, and what could not be checked, goes to the error stream, by `name`. Exit code 2 where
/// no vehicle could fly it, 1 where this one cannot.
MissionInbox::Items flyable_items(const NetworkOptions& network, const MissionFile& mission,
                                  const std::string& name, const UploadPlan& plan);

/// Brings items to the vehicle in place of those that it has, and reads them back. Exit code 1
/// where it refuses them or they do not get there.
void send_mission(const GroundOptions& network, MissionInbox::Items items, double patience_s);

/// The vehicle's mission; without items where it has none.
MissionFile fetch_mission(const NetworkOptions& network, double patience_s);

}  // namespace swiftlet
