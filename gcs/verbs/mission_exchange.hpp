// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "components/commander/mission_inbox.hpp"
#include "gcs/command/ground_options.hpp"
#include "gcs/mission/mission_file.hpp"
#include "gcs/transfer/mission_transfer.hpp"

/// Missions between files and the vehicle, for the verbs that do so. Whatever fails ends the verb
/// (end_verb) with its reason.
namespace swiftlet {

/// Of a transfer that may take long without anything being wrong [s].
inline const double kTransferPatience = to_seconds(TransferParams().patience);

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
  double patience = kTransferPatience;       ///< for the vehicle to be heard [s]
  const MissionFile* in_place_of = nullptr;  ///< what it has in common with that may be wrong
};

/// Exit code 2 where no vehicle could fly it anywhere, for which none has to be there; why goes to
/// the error stream, by `name`. `in_place_of` as in UploadPlan.
void refuse_unflyable(const MissionFile& mission, const std::string& name,
                      const MissionFile* in_place_of = nullptr);

/// Its items, where the vehicle can fly it by all that it says of itself and of the place; what was
/// found, and what could not be checked, goes to the error stream, by `name`. Exit code 1 where
/// it cannot.
MissionInbox::Items flyable_items(const GroundStation& station, const MissionFile& mission,
                                  const std::string& name, const UploadPlan& plan);

/// Brings items to the vehicle in place of those that it has, and reads them back. Exit code 1
/// where it refuses them or they do not get there.
void send_mission(const GroundStation& station, MissionInbox::Items items, double patience_s);

/// The vehicle's mission; without items where it has none.
MissionFile fetch_mission(const GroundStation& station, double patience_s);

}  // namespace swiftlet
