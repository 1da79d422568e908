// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gcs/screen/state/event_log.hpp"

namespace swiftlet::screen {

/// One line of a program's log.
struct LogLine {
  Severity severity = Severity::kNote;
  std::string text;
};
/// "[12:00:00.000] [warning] planner: text" without its time; colours are taken out. Any other
/// line stays as it is.
LogLine parse_log_line(const std::string& line);

/// What this process writes to its error stream, where that is the terminal which the screen is
/// drawn in: it would be written across the picture. What nobody has taken at the end is written
/// there after all.
class ErrorLines {
 public:
  ErrorLines();
  ~ErrorLines();
  ErrorLines(const ErrorLines&) = delete;
  ErrorLines& operator=(const ErrorLines&) = delete;

  /// Whole lines that came since the last call.
  std::vector<LogLine> take();

 private:
  void read_all();

  int before_ = -1;  // the error stream as it was; -1: it is left alone
  int pipe_ = -1;
  std::string received_;
};

}  // namespace swiftlet::screen
