// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/terminal/terminal.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>

namespace swiftlet {
namespace {

/// After which the terminal must be as before: ends, and stops by Ctrl-Z.
constexpr std::array kSignals = {SIGINT,  SIGTERM, SIGHUP, SIGQUIT, SIGABRT,
                                 SIGSEGV, SIGBUS,  SIGFPE, SIGTSTP};

// A signal handler can reach nothing but globals.
termios g_before{};
termios g_during{};
std::array<struct sigaction, kSignals.size()> g_handlers{};
struct sigaction g_continue {};
std::atomic<bool> g_active{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");

void restore() {
  if (g_active.exchange(false)) tcsetattr(STDIN_FILENO, TCSANOW, &g_before);
}

/// Gives the terminal back, then does what would have been done without us.
void on_signal(int signal) {
  restore();
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    if (kSignals[i] != signal) continue;
    sigaction(signal, &g_handlers[i], nullptr);
    if (g_handlers[i].sa_handler != SIG_DFL && g_handlers[i].sa_handler != SIG_IGN) {
      g_handlers[i].sa_handler(signal);
    } else {
      raise(signal);  // delivered when this handler returns
    }
  }
}

void install(int signal, struct sigaction* before) {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, before);
}

/// Back from Ctrl-Z, in the foreground or not.
void on_continue(int) {
  if (tcgetpgrp(STDIN_FILENO) != getpgrp()) return;
  install(SIGTSTP, nullptr);
  if (!g_active.exchange(true)) tcsetattr(STDIN_FILENO, TCSANOW, &g_during);
}

int columns() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

}  // namespace

std::vector<Key> take_keys(std::string& input) {
  constexpr char kEscape = '\x1b';
  std::vector<Key> keys;
  std::size_t at = 0;
  while (at < input.size()) {
    if (input[at] != kEscape) {
      // Characters that no keyboard sends as they are must not pass for one of ours.
      if (input[at] >= ' ') keys.push_back(key(input[at]));
      ++at;
      continue;
    }
    if (at + 1 == input.size()) break;
    if (input[at + 1] != '[' && input[at + 1] != 'O') {
      ++at;  // the key Escape itself
      continue;
    }
    // Parameters, then one character from '@' on: ESC [ 1 ; 5 C is Ctrl and an arrow.
    std::size_t end = at + 2;
    while (end < input.size() && (input[end] < '@' || input[end] > '~')) ++end;
    if (end == input.size()) break;
    if (input[end] == 'C') keys.push_back(Key::kRight);
    if (input[end] == 'D') keys.push_back(Key::kLeft);
    at = end + 1;
  }
  input.erase(0, at);
  return keys;
}

Terminal::Terminal() {
  has_status_ = isatty(STDOUT_FILENO) == 1;
  const bool foreground = isatty(STDIN_FILENO) == 1 && tcgetpgrp(STDIN_FILENO) == getpgrp();
  if (!foreground || tcgetattr(STDIN_FILENO, &g_before) != 0) return;
  g_during = g_before;
  g_during.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  g_during.c_cc[VMIN] = 0;
  g_during.c_cc[VTIME] = 0;
  has_keys_ = true;
  for (std::size_t i = 0; i < kSignals.size(); ++i) install(kSignals[i], &g_handlers[i]);
  struct sigaction action {};
  action.sa_handler = on_continue;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGCONT, &action, &g_continue);
  g_active = true;
  tcsetattr(STDIN_FILENO, TCSANOW, &g_during);
}

Terminal::~Terminal() {
  clear();
  if (!has_keys_) return;
  restore();
  sigaction(SIGCONT, &g_continue, nullptr);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    struct sigaction now {};
    sigaction(kSignals[i], nullptr, &now);
    // One that came meanwhile has given up its handler already.
    if (now.sa_handler == on_signal) sigaction(kSignals[i], &g_handlers[i], nullptr);
  }
}

std::vector<Key> Terminal::keys() {
  if (!has_keys_ || !g_active) return {};
  pollfd ready{STDIN_FILENO, POLLIN, 0};
  std::array<char, 64> buffer{};
  while (poll(&ready, 1, 0) > 0 && (ready.revents & POLLIN) != 0) {
    const ssize_t count = read(STDIN_FILENO, buffer.data(), buffer.size());
    if (count <= 0) break;
    input_.append(buffer.data(), static_cast<std::size_t>(count));
  }
  return take_keys(input_);
}

void Terminal::show(const std::string& status) {
  if (!has_status_) return;
  fmt::print("\r{}\x1b[K", status.substr(0, static_cast<std::size_t>(columns() - 1)));
  std::fflush(stdout);
  shown_ = true;
}

void Terminal::clear() {
  if (!shown_) return;
  fmt::print("\r\x1b[K");
  std::fflush(stdout);
  shown_ = false;
}

}  // namespace swiftlet
