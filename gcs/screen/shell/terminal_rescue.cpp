// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/shell/terminal_rescue.hpp"

#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>

namespace swiftlet::screen {
namespace {

constexpr std::array kSignals = {SIGHUP, SIGQUIT, SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL};

/// Leaves the alternate screen, shows the cursor, ends attributes and application keys: what every
/// terminal in use understands. A signal handler cannot ask a data base for more.
constexpr char kReset[] = "\x1b[m\x1b[?1049l\x1b[?25h\x1b[?1l\x1b>\r";

// A signal handler can reach nothing but globals.
termios g_before{};
int g_stderr = -1;
std::array<struct sigaction, kSignals.size()> g_handlers{};
std::atomic<bool> g_active{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");

void on_signal(int signal) {
  if (g_active.exchange(false)) {
    // Nothing can be done about it where that fails.
    [[maybe_unused]] const ssize_t written = write(STDOUT_FILENO, kReset, sizeof(kReset) - 1);
    tcsetattr(STDIN_FILENO, TCSANOW, &g_before);
    dup2(g_stderr, STDERR_FILENO);
  }
  std::signal(signal, SIG_DFL);
  raise(signal);  // delivered when this handler returns
}

}  // namespace

void rescue_terminal_at_end() {
  tcgetattr(STDIN_FILENO, &g_before);
  g_stderr = dup(STDERR_FILENO);
  g_active = true;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    struct sigaction action {};
    action.sa_handler = on_signal;
    sigemptyset(&action.sa_mask);
    sigaction(kSignals[i], &action, &g_handlers[i]);
  }
}

void forget_rescue() {
  if (!g_active.exchange(false)) return;
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &g_handlers[i], nullptr);
  close(g_stderr);
}

}  // namespace swiftlet::screen
