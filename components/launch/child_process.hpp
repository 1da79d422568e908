// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <poll.h>
#include <sys/types.h>

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace swiftlet {

/// How a process ended: with an exit code, or by a signal.
struct ChildEnd {
  int exit_code = 0;
  int signal = 0;  ///< 0 where it was none

  bool crashed() const { return signal != 0 || (exit_code != 0 && exit_code != 2); }
};

/// "ended with exit code 1", "was ended by signal 9 (Killed)".
std::string describe(const ChildEnd& end);

/// A running process. What it writes comes out of ours, line by line, with its name before each.
/// It dies with us, however we die.
class ChildProcess {
 public:
  /// Throws RuntimeError where the program cannot be started.
  ChildProcess(const std::string& name, const std::vector<std::string>& words);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t id() const { return id_; }
  void send(int signal) const;
  /// Adds what poll() is to wait for.
  void add_to(std::vector<pollfd>& list) const;
  /// Passes on what it has written so far, without waiting.
  void forward();
  /// Nothing while it runs. Once it has ended, everything that it wrote is passed on.
  std::optional<ChildEnd> ended();

 private:
  struct Stream {
    int descriptor = -1;
    std::FILE* target = nullptr;
    std::string pending{};  // a line that is not complete yet
  };
  void forward(Stream& stream);
  void print(Stream& stream, const std::string& line) const;

  std::string name_;
  pid_t id_ = -1;
  int process_ = -1;  // becomes readable when the process ends
  Stream streams_[2];
};

}  // namespace swiftlet
