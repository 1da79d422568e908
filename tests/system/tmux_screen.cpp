// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/system/tmux_screen.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

namespace swiftlet::test {
namespace {

constexpr Seconds kTmuxLimit{10.0};

}  // namespace

bool TmuxScreen::available() {
  return std::system("command -v tmux > /dev/null") == 0;
}

TmuxScreen::TmuxScreen(const std::string& command, int width, int height,
                       Process::Environment environment, const std::filesystem::path& folder)
    : environment_(std::move(environment)), folder_(folder) {
  environment_["TMUX_TMPDIR"] = folder_.string();
  environment_.try_emplace("LC_ALL", "C.UTF-8");
  // All lines are the program's.
  std::ofstream(folder_ / "tmux.conf") << "set -g status off\nset -g escape-time 0\n";
  tmux({"new-session", "-d", "-x", std::to_string(width), "-y", std::to_string(height), command});
}

TmuxScreen::~TmuxScreen() {
  tmux({"kill-server"});
}

std::string TmuxScreen::tmux(std::vector<std::string> arguments) {
  std::vector<std::string> command{"tmux", "-f", (folder_ / "tmux.conf").string(), "-L", "screen"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  Process process(command, environment_, folder_ / ("tmux" + std::to_string(++runs_ % 2)));
  const auto finished = process.wait(kTmuxLimit);
  return finished && finished->exit_code == 0 ? finished->out : "";
}

void TmuxScreen::press(const std::string& key, int times) {
  tmux({"send-keys", "-N", std::to_string(times), key});
}

void TmuxScreen::resize(int width, int height) {
  tmux({"resize-window", "-x", std::to_string(width), "-y", std::to_string(height)});
}

std::string TmuxScreen::text() {
  return tmux({"capture-pane", "-p"});
}

bool TmuxScreen::shows(const std::string& what, Seconds limit) {
  std::string last;
  const bool shown = becomes_true(limit, [&] {
    last = text();
    return last.find(what) != std::string::npos;
  });
  EXPECT_TRUE(shown) << "never shows '" << what << "':\n" << last;
  return shown;
}

bool TmuxScreen::ended() {
  return becomes_true(kTmuxLimit, [this] { return tmux({"list-sessions"}).empty(); });
}

}  // namespace swiftlet::test
