// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/slowdown.hpp"

namespace swiftlet::test {

using Seconds = std::chrono::duration<double>;

/// A moment, so that polling leaves the processor to those who are polled.
void pause_between_polls();

/// Asks `condition` again and again until it holds; false where it does not within `limit`.
template <class Condition>
bool becomes_true(Seconds limit, Condition condition) {
  const auto end = std::chrono::steady_clock::now() + limit * kSlowdown;
  do {
    if (condition()) return true;
    pause_between_polls();
  } while (std::chrono::steady_clock::now() < end);
  return condition();
}

/// What a process left behind.
struct Finished {
  int exit_code = 0;  ///< as a shell has it: 128 + signal for one that a signal ended
  std::string out;
  std::string err;
  Seconds duration{};
};

/// A real process. What it writes goes to two files; it ends with this object, or with the test
/// program, whichever is first.
class Process {
 public:
  using Environment = std::map<std::string, std::string>;

  /// Starts `command`, whose first word is looked up in PATH, with `environment` on top of ours.
  /// Output goes to <log>.out and <log>.err. Exit code 127: there is no such program.
  Process(const std::vector<std::string>& command, const Environment& environment,
          const std::filesystem::path& log);
  ~Process();
  Process(Process&& other) noexcept;
  Process& operator=(Process&& other) noexcept;
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t id() const { return id_; }
  /// Sends a signal. Does nothing where the process has ended.
  void send(int signal) const;
  bool running();
  /// Nothing where it still runs after `limit`; it goes on then.
  std::optional<Finished> wait(Seconds limit);

  /// What it has written so far.
  std::string out() const;
  std::string err() const;

 private:
  pid_t id_ = -1;
  std::filesystem::path log_;
  std::chrono::steady_clock::time_point begin_;
  std::optional<int> exit_code_;
  Seconds duration_{};
};

}  // namespace swiftlet::test
