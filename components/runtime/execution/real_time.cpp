// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/execution/real_time.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <limits>
#include <system_error>

namespace swiftlet {
namespace {

std::string text_of(int error) {
  return std::generic_category().message(error);
}

Status schedule(int priority) {
  sched_param param{};
  param.sched_priority = priority;
  if (sched_setscheduler(0, SCHED_FIFO, &param) == 0) return {};
  return Error{
      fmt::format("no SCHED_FIFO with priority {}: {}; give the process CAP_SYS_NICE, or its user "
                  "an 'rtprio' of "
                  "at least {} in /etc/security/limits.conf",
                  priority, text_of(errno), priority)};
}

/// Pages are locked when they are first touched: buffers that are reserved for the worst case (a
/// thread's stack, room behind a datagram) would else take all of their memory at once.
Status lock_memory() {
  if (mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0) return {};
  return Error{fmt::format(
      "memory is not locked: {}; give the process CAP_IPC_LOCK, or its user an unlimited 'memlock' "
      "in /etc/security/limits.conf",
      text_of(errno))};
}

/// The most that malloc takes for this: larger blocks are mapped one by one [B].
constexpr int kLargestKept = 32 << 20;

}  // namespace

RealTimeGrant ask_for_real_time(int priority) {
  return {schedule(priority), lock_memory()};
}

void keep_memory() {
  // Refused only by allocators that have no such settings.
  (void)mallopt(M_MMAP_THRESHOLD, kLargestKept);
  (void)mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
}

}  // namespace swiftlet
