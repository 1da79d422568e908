// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "components/launch/child_process.hpp"
#include "components/launch/system_file.hpp"

namespace swiftlet {

struct SupervisorOptions {
  RestartPolicy restart;
  bool stop_on_failure = true;
  double stop_timeout = 5.0;  ///< from SIGTERM to SIGKILL [s]
};

/// Runs processes side by side, forwards what they write, and starts again those that crash.
///
/// A process that ends with 0 has done its work, and one that ends with 2 was started wrongly:
/// neither is started again. Any other end is a crash.
class Supervisor {
 public:
  Supervisor(const std::vector<CommandLine>& lines, const SupervisorOptions& options);
  ~Supervisor();

  /// Until all have ended, or SIGINT or SIGTERM: then asks all to end, and kills those that do not.
  /// 0, or 1 where a process was given up or had to be killed.
  int run();

 private:
  using Clock = std::chrono::steady_clock;

  struct Place {
    CommandLine line;
    std::unique_ptr<ChildProcess> process;      // null while there is none
    std::optional<Clock::time_point> start_at;  // of the next start
    std::deque<Clock::time_point> restarts{};   // within the window
  };

  void start(Place& place);
  void handle_end(Place& place, const ChildEnd& end);
  void give_up(Place& place, const std::string& why);
  void stop_all(const std::string& why);
  void kill_late_ones();
  void wait_for_something();
  bool done() const;
  int timeout_ms() const;

  SupervisorOptions options_;
  std::vector<Place> places_;
  int signals_ = -1;  // descriptor from which SIGINT and SIGTERM are read
  std::optional<Clock::time_point> kill_at_;
  bool stopping_ = false;
  bool failed_ = false;
};

}  // namespace swiftlet
