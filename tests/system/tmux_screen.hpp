// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/system/process.hpp"

namespace swiftlet::test {

/// A terminal of a given size with a program in it, by tmux: keys go in, text comes out. It ends
/// with this object.
class TmuxScreen {
 public:
  /// Whether there is a tmux.
  static bool available();

  /// `command` as a shell reads it; `folder` for sockets and logs.
  TmuxScreen(const std::string& command, int width, int height, Process::Environment environment,
             const std::filesystem::path& folder);
  ~TmuxScreen();
  TmuxScreen(const TmuxScreen&) = delete;
  TmuxScreen& operator=(const TmuxScreen&) = delete;

  /// Names as tmux has them: "a", "Enter", "Right".
  void press(const std::string& key, int times = 1);
  void resize(int width, int height);
  /// What is to be seen, line by line.
  std::string text();
  /// Waits until it is to be seen; reports the last picture where it is not.
  bool shows(const std::string& what, Seconds limit);
  /// The program has ended, and with it the terminal.
  bool ended();

 private:
  std::string tmux(std::vector<std::string> arguments);

  Process::Environment environment_;
  std::filesystem::path folder_;
  int runs_ = 0;
};

}  // namespace swiftlet::test
