// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/signals.hpp"

#include <atomic>
#include <csignal>

namespace swiftlet {
namespace {

// A signal handler can reach nothing but a global.
volatile std::sig_atomic_t g_received = 0;

void note(int signal) {
  g_received = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

SignalGuard::SignalGuard() {
  g_received = 0;
  std::signal(SIGINT, note);
  std::signal(SIGTERM, note);
}

SignalGuard::~SignalGuard() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool SignalGuard::received() const {
  return g_received != 0;
}

}  // namespace swiftlet
