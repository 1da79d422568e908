// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace swiftlet {

/// How a topic's samples are delivered. Every topic uses one of the named profiles below.
struct QosProfile {
  const char* name;
  bool reliable;         ///< lost samples are sent again
  bool transient_local;  ///< who comes later gets the last samples too
  int depth;             ///< samples kept for a reader that is busy
  bool large;            ///< samples above 64 kB: sent by a thread of their own
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

}  // namespace qos

/// Why a reader that asks for `requested` does not get what a writer with `offered` sends: the
/// policy and both values; "" where they fit together (DDS 1.4, 2.2.3).
std::string qos_conflict(const QosProfile& offered, const QosProfile& requested);

}  // namespace swiftlet
