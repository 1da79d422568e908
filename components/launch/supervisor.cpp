// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/launch/supervisor.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>

#include "components/runtime/log.hpp"
#include "components/runtime/runtime_error.hpp"

namespace swiftlet {
namespace {

constexpr int kWrongUsage = 2;

Logger log() {
  return logger("launch");
}

std::chrono::steady_clock::duration seconds(double value) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(value));
}

}  // namespace

Supervisor::Supervisor(const std::vector<CommandLine>& lines, const SupervisorOptions& options)
    : options_(options) {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  sigprocmask(SIG_BLOCK, &signals, nullptr);
  signals_ = signalfd(-1, &signals, SFD_NONBLOCK | SFD_CLOEXEC);
  for (const CommandLine& line : lines) places_.push_back({line, nullptr, Clock::now()});
}

Supervisor::~Supervisor() {
  places_.clear();
  close(signals_);
}

int Supervisor::run() {
  while (true) {
    const Clock::time_point now = Clock::now();
    for (Place& place : places_) {
      if (!stopping_ && place.start_at && *place.start_at <= now) start(place);
    }
    if (done()) break;
    wait_for_something();
    signalfd_siginfo signal;
    if (read(signals_, &signal, sizeof(signal)) == sizeof(signal)) {
      stop_all(fmt::format("signal {}", signal.ssi_signo));
    }
    for (Place& place : places_) {
      if (!place.process) continue;
      place.process->forward();
      if (const auto end = place.process->ended()) handle_end(place, *end);
    }
    kill_late_ones();
  }
  return failed_ ? 1 : 0;
}

void Supervisor::start(Place& place) {
  place.start_at.reset();
  try {
    place.process = std::make_unique<ChildProcess>(place.line.name, place.line.words);
    log()->info("{}: started, process {}", place.line.name, place.process->id());
  } catch (const RuntimeError& error) {
    give_up(place, error.what());
  }
}

void Supervisor::handle_end(Place& place, const ChildEnd& end) {
  const std::string& name = place.line.name;
  place.process.reset();
  if (stopping_) {
    log()->info("{}: {}", name, describe(end));
    // Some programs let the signal that we sent end them; that is what was asked for.
    if (end.crashed() && end.signal != SIGTERM) failed_ = true;
    return;
  }
  if (!end.crashed()) {
    if (end.exit_code == kWrongUsage) {
      give_up(place,
              fmt::format("{}: refused to start, see above; starting it again cannot help", name));
    } else {
      log()->info("{}: has done its work and ended", name);
    }
    return;
  }
  const Clock::time_point now = Clock::now();
  auto& restarts = place.restarts;
  while (!restarts.empty() && now - restarts.front() > seconds(options_.restart.window)) {
    restarts.pop_front();
  }
  const int count = static_cast<int>(restarts.size());
  if (count >= options_.restart.max_restarts) {
    give_up(place, fmt::format("{}: {}; it was started again {} times in {} s, which is enough",
                               name, describe(end), count, options_.restart.window));
    return;
  }
  const double backoff = std::max(
      place.line.pause, std::min(options_.restart.max_backoff,
                                 options_.restart.backoff * std::pow(2.0, std::min(count, 30))));
  restarts.push_back(now);
  place.start_at = now + seconds(backoff);
  log()->warn("{}: {}; starting it again in {:.1f} s ({} of {} in {} s)", name, describe(end),
              backoff, count + 1, options_.restart.max_restarts, options_.restart.window);
}

void Supervisor::give_up(Place& place, const std::string& why) {
  failed_ = true;
  place.start_at.reset();
  log()->error("{}", why);
  if (options_.stop_on_failure) {
    stop_all(fmt::format("{} is given up (on_failure: stop)", place.line.name));
  } else {
    log()->error("{}: given up; the others go on (on_failure: continue)", place.line.name);
  }
}

void Supervisor::stop_all(const std::string& why) {
  if (stopping_) return;
  stopping_ = true;
  kill_at_ = Clock::now() + seconds(options_.stop_timeout);
  log()->info("ending all: {}", why);
  for (Place& place : places_) {
    place.start_at.reset();
    if (place.process) place.process->send(SIGTERM);
  }
}

void Supervisor::kill_late_ones() {
  if (!kill_at_ || Clock::now() < *kill_at_) return;
  kill_at_.reset();
  for (Place& place : places_) {
    if (!place.process) continue;
    log()->error("{}: does not end within {} s and is killed", place.line.name,
                 options_.stop_timeout);
    failed_ = true;
    place.process->send(SIGKILL);
  }
}

void Supervisor::wait_for_something() {
  std::vector<pollfd> list{{signals_, POLLIN, 0}};
  for (const Place& place : places_) {
    if (place.process) place.process->add_to(list);
  }
  poll(list.data(), list.size(), timeout_ms());
}

int Supervisor::timeout_ms() const {
  std::optional<Clock::time_point> next = kill_at_;
  for (const Place& place : places_) {
    if (place.start_at && (!next || *place.start_at < *next)) next = place.start_at;
  }
  if (!next) return -1;
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(*next - Clock::now());
  return static_cast<int>(std::clamp<std::int64_t>(left.count() + 1, 0, 3'600'000));
}

bool Supervisor::done() const {
  return std::none_of(places_.begin(), places_.end(), [](const Place& place) {
    return place.process != nullptr || place.start_at.has_value();
  });
}

}  // namespace swiftlet
