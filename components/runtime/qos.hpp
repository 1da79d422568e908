// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "estimation/basics/time.hpp"

namespace swiftlet {

inline constexpr Duration kUnlimited = Duration::max();

/// How a writer says that it lives, from the weakest to the strongest promise.
enum class Liveliness { kAutomatic, kByParticipant, kByTopic };

/// How a topic's samples are delivered. Every topic uses one of the named profiles below; a file
/// given by the user may change them (QosOverrides).
struct QosProfile {
  const char* name;
  bool reliable;         ///< lost samples are sent again
  bool transient_local;  ///< who comes later gets the last samples too
  int depth;             ///< samples kept for a reader that is busy; 0: not known
  bool large;            ///< samples above 64 kB: where somebody waits, sent by a thread of its own

  // What a writer offers and a reader asks for. By default as ROS 2 does: nothing is asked for, so
  // that every writer will do.
  Duration deadline = kUnlimited;  ///< the longest time between two samples
  Duration latency_budget{0};      ///< a sample may be that late
  Liveliness liveliness = Liveliness::kAutomatic;
  Duration lease = kUnlimited;  ///< a writer that said nothing for so long counts as dead
  bool exclusive = false;       ///< only the strongest writer is heard
  bool by_source_time = false;  ///< samples in the order of their writing, not of their arrival

  // What only one end has.
  Duration lifespan = kUnlimited;  ///< a sample that is older is not delivered
  int strength = 0;                ///< of a writer, where exclusive
  bool at_once = false;            ///< of a reader: see at_once() in topic.hpp
};

namespace qos {

/// Measurements at a rate: the newest matters, a lost one is not worth waiting for.
inline constexpr QosProfile sensor{"sensor", false, false, 32, false};
/// Estimates and states that others act on.
inline constexpr QosProfile state{"state", true, false, 32, false};
/// What somebody is told to do.
inline constexpr QosProfile command{"command", true, false, 32, false};
/// One value that stays true until the next: maps, static transforms, what a late reader needs.
inline constexpr QosProfile map{"map", true, true, 1, true};
/// Happenings, each of which counts.
inline constexpr QosProfile event{"event", true, false, 256, false};
/// Images and clouds: large, at a rate.
inline constexpr QosProfile bulk{"bulk", false, false, 4, true};

/// The same for a topic whose readers need the last `depth` samples.
constexpr QosProfile keeping(QosProfile profile, int depth) {
  profile.depth = depth;
  return profile;
}

/// All of them, for who takes a name from a person.
inline constexpr const QosProfile* profiles[] = {&sensor, &state, &command, &map, &event, &bulk};

}  // namespace qos

/// Why a reader that asks for `requested` does not get what a writer with `offered` sends: the
/// policy and both values; "" where they fit together (DDS 1.4, 2.2.3).
std::string qos_conflict(const QosProfile& offered, const QosProfile& requested);

}  // namespace swiftlet
