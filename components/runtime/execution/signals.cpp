// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/execution/signals.hpp"

#include <atomic>
#include <csignal>

namespace swiftlet {
namespace {

// A signal handler can reach nothing but a global, and any thread may run it.
std::atomic<bool> g_received{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");

void note(int signal) {
  g_received = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

SignalGuard::SignalGuard() {
  g_received = false;
  std::signal(SIGINT, note);
  std::signal(SIGTERM, note);
}

SignalGuard::~SignalGuard() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool SignalGuard::received() const {
  return g_received;
}

}  // namespace swiftlet
