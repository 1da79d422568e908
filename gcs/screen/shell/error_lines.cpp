// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/shell/error_lines.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdio>

namespace swiftlet::screen {
namespace {

/// Without ESC [ ... letter.
std::string without_colours(const std::string& line) {
  std::string text;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] != '\x1b') {
      text += line[i];
      continue;
    }
    while (i + 1 < line.size() && (line[i] < '@' || line[i] == '[')) ++i;
  }
  return text;
}

}  // namespace

LogLine parse_log_line(const std::string& line) {
  const std::string text = without_colours(line);
  const std::size_t level = text.find("] [");
  const std::size_t end = level == std::string::npos ? level : text.find("] ", level + 3);
  if (text.empty() || text[0] != '[' || end == std::string::npos) return {Severity::kNote, text};
  const std::string name = text.substr(level + 3, end - level - 3);
  Severity severity = Severity::kNote;
  if (name == "warning") severity = Severity::kCaution;
  if (name == "error" || name == "critical") severity = Severity::kDanger;
  return {severity, text.substr(end + 2)};
}

ErrorLines::ErrorLines() {
  std::array<int, 2> ends{};
  if (isatty(STDERR_FILENO) != 1) return;
  // A writer that finds the pipe full must not wait: those who write hold locks.
  if (pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC) != 0) return;
  std::fflush(stderr);
  before_ = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0);
  pipe_ = ends[0];
  dup2(ends[1], STDERR_FILENO);
  close(ends[1]);
}

ErrorLines::~ErrorLines() {
  if (before_ < 0) return;
  std::fflush(stderr);
  read_all();
  dup2(before_, STDERR_FILENO);
  close(before_);
  close(pipe_);
  std::fputs(received_.c_str(), stderr);
}

void ErrorLines::read_all() {
  std::array<char, 4096> buffer{};
  for (ssize_t count = 1; count > 0;) {
    count = read(pipe_, buffer.data(), buffer.size());
    if (count > 0) received_.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

std::vector<LogLine> ErrorLines::take() {
  std::vector<LogLine> lines;
  if (before_ < 0) return lines;
  read_all();
  for (std::size_t end = received_.find('\n'); end != std::string::npos;
       end = received_.find('\n')) {
    if (end > 0) lines.push_back(parse_log_line(received_.substr(0, end)));
    received_.erase(0, end + 1);
  }
  return lines;
}

}  // namespace swiftlet::screen
