// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/system/process.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>
#include <utility>

namespace swiftlet::test {
namespace {

constexpr int kCannotStart = 127;  // as a shell has it

std::string with_extension(const std::filesystem::path& log, const char* extension) {
  return log.string() + extension;
}

std::string content(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// In the child: from here to exec.
[[noreturn]] void become(const std::vector<char*>& arguments, const Process::Environment& changes,
                         const std::string& out, const std::string& err) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test program that crashes leaves nothing behind
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int flags = O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC;
  dup2(nothing, STDIN_FILENO);
  dup2(open(out.c_str(), flags, 0644), STDOUT_FILENO);
  dup2(open(err.c_str(), flags, 0644), STDERR_FILENO);
  for (const auto& [name, value] : changes) setenv(name.c_str(), value.c_str(), 1);
  execvp(arguments[0], arguments.data());
  _exit(kCannotStart);
}

int exit_code_of(int status) {
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace

void pause_between_polls() {
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

Process::Process(const std::vector<std::string>& command, const Environment& environment,
                 const std::filesystem::path& log)
    : log_(log), begin_(std::chrono::steady_clock::now()) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const std::string out = with_extension(log_, ".out");
  const std::string err = with_extension(log_, ".err");
  id_ = fork();
  if (id_ < 0) throw std::runtime_error(std::string("cannot fork: ") + std::strerror(errno));
  if (id_ == 0) become(arguments, environment, out, err);
}

Process::Process(Process&& other) noexcept
    : id_(std::exchange(other.id_, -1)),
      log_(std::move(other.log_)),
      begin_(other.begin_),
      exit_code_(other.exit_code_),
      duration_(other.duration_) {}

Process& Process::operator=(Process&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(log_, other.log_);
  std::swap(begin_, other.begin_);
  std::swap(exit_code_, other.exit_code_);
  std::swap(duration_, other.duration_);
  return *this;
}

Process::~Process() {
  if (!running()) return;
  send(SIGKILL);
  waitpid(id_, nullptr, 0);
}

void Process::send(int signal) const {
  // A process that was waited for is gone, and its number may be somebody else's.
  if (id_ > 0 && !exit_code_) kill(id_, signal);
}

bool Process::running() {
  if (id_ <= 0 || exit_code_) return false;
  int status = 0;
  if (waitpid(id_, &status, WNOHANG) != id_) return true;
  exit_code_ = exit_code_of(status);
  duration_ = std::chrono::steady_clock::now() - begin_;
  return false;
}

std::optional<Finished> Process::wait(Seconds limit) {
  if (!becomes_true(limit, [this] { return !running(); })) return std::nullopt;
  return Finished{*exit_code_, out(), err(), duration_};
}

std::string Process::out() const {
  return content(with_extension(log_, ".out"));
}

std::string Process::err() const {
  return content(with_extension(log_, ".err"));
}

}  // namespace swiftlet::test
