// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>
#include <termios.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/system/process.hpp"

namespace swiftlet::test {

/// A process in a terminal of its own (a pty), whose keys we press and whose screen we read.
class PtyProcess {
 public:
  PtyProcess(const std::vector<std::string>& command, const Process::Environment& environment);
  ~PtyProcess();
  PtyProcess(const PtyProcess&) = delete;
  PtyProcess& operator=(const PtyProcess&) = delete;

  void press(const std::string& keys) const;
  void send(int signal) const;
  /// All that was written to the terminal so far.
  const std::string& screen();
  /// Waits until the screen shows a text that was not there when `from` bytes were.
  bool shows(const std::string& text, std::size_t from = 0);
  /// The exit code as a shell has it; nothing where the process still runs after `limit`.
  std::optional<int> wait(Seconds limit);

  /// Whether lines are edited and shown, as a shell needs it.
  bool is_cooked() const;

 private:
  pid_t id_ = -1;
  int master_ = -1;
  int terminal_ = -1;  // the process's side, kept open to look at
  std::string screen_;
  std::optional<int> exit_code_;
};

}  // namespace swiftlet::test
