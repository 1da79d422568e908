// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/components/bag/pty_process.hpp"

#include <fcntl.h>
#include <pty.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utmp.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <stdexcept>

namespace swiftlet::test {

PtyProcess::PtyProcess(const std::vector<std::string>& command,
                       const Process::Environment& environment) {
  winsize size{};
  size.ws_col = 120;
  size.ws_row = 24;
  if (openpty(&master_, &terminal_, nullptr, nullptr, &size) != 0) {
    throw std::runtime_error("cannot open a terminal");
  }
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  id_ = fork();
  if (id_ < 0) throw std::runtime_error("cannot fork");
  if (id_ == 0) {
    close(master_);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    login_tty(terminal_);
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  fcntl(master_, F_SETFL, O_NONBLOCK);
}

PtyProcess::~PtyProcess() {
  if (!exit_code_) {
    kill(id_, SIGKILL);
    waitpid(id_, nullptr, 0);
  }
  close(master_);
  close(terminal_);
}

void PtyProcess::press(const std::string& keys) const {
  const ssize_t written = write(master_, keys.data(), keys.size());
  if (written != static_cast<ssize_t>(keys.size())) throw std::runtime_error("cannot press keys");
}

void PtyProcess::send(int signal) const {
  if (!exit_code_) kill(id_, signal);
}

const std::string& PtyProcess::screen() {
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t count = read(master_, buffer.data(), buffer.size());
    if (count <= 0) return screen_;
    screen_.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

bool PtyProcess::shows(const std::string& text, std::size_t from) {
  return becomes_true(Seconds(15.0),
                      [&] { return screen().find(text, from) != std::string::npos; });
}

std::optional<int> PtyProcess::wait(Seconds limit) {
  becomes_true(limit, [this] {
    screen();  // a terminal that nobody reads holds up who writes
    int status = 0;
    if (!exit_code_ && waitpid(id_, &status, WNOHANG) == id_) {
      exit_code_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    }
    return exit_code_.has_value();
  });
  return exit_code_;
}

bool PtyProcess::is_cooked() const {
  termios now{};
  tcgetattr(terminal_, &now);
  return (now.c_lflag & ICANON) != 0 && (now.c_lflag & ECHO) != 0;
}

}  // namespace swiftlet::test
