// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/launch/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "components/runtime/runtime_error.hpp"

namespace swiftlet {
namespace {

/// A process that writes without ever ending the line does not fill our memory.
constexpr std::size_t kLongestLine = 16384;

/// In the child: from here to exec. Writes errno to `report` where that fails.
[[noreturn]] void become(const std::vector<char*>& words, pid_t parent, int out, int err,
                         int report) {
  // SIGKILL, not SIGTERM: a component that hangs must not go on publishing when nobody watches it.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // which died before it could be watched
  // In a group of its own, so that Ctrl-C reaches the launch alone, which then ends all in order.
  setpgid(0, 0);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  dup2(open("/dev/null", O_RDONLY | O_CLOEXEC), STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  execvp(words[0], words.data());
  const int error = errno;
  (void)!write(report, &error, sizeof(error));
  _exit(127);
}

struct Pipe {
  int read = -1;
  int write = -1;
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) {
      throw RuntimeError(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
    }
    read = ends[0];
    write = ends[1];
  }
};

}  // namespace

std::string describe(const ChildEnd& end) {
  return end.signal != 0
             ? fmt::format("was ended by signal {} ({})", end.signal, strsignal(end.signal))
             : fmt::format("ended with exit code {}", end.exit_code);
}

ChildProcess::ChildProcess(const std::string& name, const std::vector<std::string>& words)
    : name_(name) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const Pipe out, err, report;
  const pid_t parent = getpid();
  id_ = fork();
  if (id_ == 0) become(arguments, parent, out.write, err.write, report.write);
  const int fork_error = errno;
  for (const Pipe* pipe : {&out, &err, &report}) close(pipe->write);
  streams_[0] = {out.read, stdout};
  streams_[1] = {err.read, stderr};
  // Ends with exec, which closes the other end, or brings the reason why there was none.
  int exec_error = 0;
  const bool started =
      id_ > 0 && read(report.read, &exec_error, sizeof(exec_error)) != sizeof(exec_error);
  close(report.read);
  if (!started) {
    if (id_ > 0) waitpid(id_, nullptr, 0);
    for (const Stream& stream : streams_) close(stream.descriptor);
    throw RuntimeError(fmt::format("{}: '{}' cannot be started: {}", name, words.front(),
                                   std::strerror(id_ > 0 ? exec_error : fork_error)));
  }
  for (const Stream& stream : streams_) fcntl(stream.descriptor, F_SETFL, O_NONBLOCK);
  // glibc 2.36 declares pidfd_open() for C alone.
  process_ = static_cast<int>(syscall(SYS_pidfd_open, id_, 0));
}

ChildProcess::~ChildProcess() {
  if (id_ > 0) {
    kill(id_, SIGKILL);
    waitpid(id_, nullptr, 0);
  }
  close(process_);
  for (const Stream& stream : streams_) close(stream.descriptor);
}

void ChildProcess::send(int signal) const {
  if (id_ > 0) kill(id_, signal);
}

void ChildProcess::add_to(std::vector<pollfd>& list) const {
  if (id_ > 0) list.push_back({process_, POLLIN, 0});
  for (const Stream& stream : streams_) {
    if (stream.descriptor >= 0) list.push_back({stream.descriptor, POLLIN, 0});
  }
}

void ChildProcess::forward() {
  for (Stream& stream : streams_) forward(stream);
}

void ChildProcess::forward(Stream& stream) {
  char buffer[4096];
  while (stream.descriptor >= 0) {
    const ssize_t size = read(stream.descriptor, buffer, sizeof(buffer));
    if (size < 0) break;  // nothing more for now
    if (size == 0) {
      close(stream.descriptor);
      stream.descriptor = -1;
      break;
    }
    stream.pending.append(buffer, static_cast<std::size_t>(size));
    std::size_t begin = 0;
    for (std::size_t end; (end = stream.pending.find('\n', begin)) != std::string::npos;
         begin = end + 1) {
      print(stream, stream.pending.substr(begin, end - begin));
    }
    stream.pending.erase(0, begin);
    if (stream.pending.size() > kLongestLine) {
      print(stream, stream.pending);
      stream.pending.clear();
    }
  }
}

void ChildProcess::print(Stream& stream, const std::string& line) const {
  fmt::print(stream.target, "[{}] {}\n", name_, line);
  std::fflush(stream.target);
}

std::optional<ChildEnd> ChildProcess::ended() {
  int status = 0;
  if (id_ <= 0 || waitpid(id_, &status, WNOHANG) != id_) return std::nullopt;
  id_ = -1;
  forward();
  for (Stream& stream : streams_) {
    if (!stream.pending.empty()) print(stream, std::exchange(stream.pending, {}));
  }
  if (WIFSIGNALED(status)) return ChildEnd{0, WTERMSIG(status)};
  return ChildEnd{WEXITSTATUS(status), 0};
}

}  // namespace swiftlet
