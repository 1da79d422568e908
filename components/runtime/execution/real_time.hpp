// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/basics/result.hpp"

namespace swiftlet {

/// What a process got of what it asked for; errors say why not, and what to do.
struct RealTimeGrant {
  Status scheduling;  ///< SCHED_FIFO
  Status memory;      ///< locked: what is in use stays in use
};

/// Asks for real-time scheduling of this thread and of all that it and its descendants start from
/// now on, and for memory that is never paged out. `priority` is from 1 to 99, as for SCHED_FIFO.
///
/// Call it before anything else of the process has threads. The kernel keeps a twentieth of each
/// second for others, so that a loop that never ends does not take the machine.
RealTimeGrant ask_for_real_time(int priority);

/// From now on memory that has been in use stays with the process when it is given back to malloc,
/// so that callbacks do not touch their pages anew each time: each costs some microseconds, tens in
/// a virtual machine. Blocks of 32 MiB and more still come and go.
void keep_memory();

}  // namespace swiftlet
