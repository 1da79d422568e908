// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// PROGRAM VARIANT BYTES both|send|receive COUNT: sends COUNT messages at 1 kHz, or receives them,
// and prints one line of JSON: latencies and the CPU time that the process took meanwhile.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "tests/bench/middleware/peer.hpp"

namespace swiftlet::bench {

using namespace std::chrono_literals;

std::int64_t steady_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

namespace {

constexpr auto kPeriod = 1ms;
constexpr std::uint32_t kWarmUp = 300;
constexpr auto kMatchLimit = 20s;
constexpr auto kSilence = 3s;  // the rest was lost

double cpu_us() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto us = [](const timeval& time) {
    return 1e6 * double(time.tv_sec) + double(time.tv_usec);
  };
  return us(usage.ru_utime) + us(usage.ru_stime);
}

/// Latencies of the messages after the warm-up.
class Recorder {
 public:
  explicit Recorder(std::uint32_t count) : count_(count) { latencies_us_.reserve(count); }

  void note(const Mark& mark) {
    const std::int64_t now = steady_ns();
    const std::lock_guard<std::mutex> lock(mutex_);
    last_ns_ = now;
    if (mark.number == 0) return;  // sent until both ends are ready
    if (mark.number <= kWarmUp) {
      cpu_begin_us_ = cpu_us();
      return;
    }
    latencies_us_.push_back(double(now - mark.sent_ns) / 1e3);
    if (mark.number == kWarmUp + count_) done_ = true;
  }

  /// Waits for the last message, or until nothing came for a while.
  void wait() {
    while (!done_) {
      std::this_thread::sleep_for(20ms);
      const std::lock_guard<std::mutex> lock(mutex_);
      const bool silent = last_ns_ != 0 && steady_ns() - last_ns_ > kSilence / 1ns;
      if (silent || (last_ns_ == 0 && steady_ns() - begin_ns_ > kMatchLimit / 1ns)) return;
    }
  }

  std::string report() {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::sort(latencies_us_.begin(), latencies_us_.end());
    const auto quantile = [&](double q) {
      return latencies_us_.empty()
                 ? 0.0
                 : latencies_us_[std::size_t(q * double(latencies_us_.size() - 1))];
    };
    return fmt::format(R"("received": {}, "p50_us": {:.1f}, "p99_us": {:.1f}, "cpu_us": {:.2f})",
                       latencies_us_.size(), quantile(0.5), quantile(0.99),
                       (cpu_us() - cpu_begin_us_) / double(count_));
  }

 private:
  const std::uint32_t count_;
  const std::int64_t begin_ns_ = steady_ns();
  std::mutex mutex_;
  std::vector<double> latencies_us_;
  double cpu_begin_us_ = cpu_us();
  std::int64_t last_ns_ = 0;
  std::atomic<bool> done_{false};
};

bool wait_for_match(Peer& peer) {
  const auto deadline = std::chrono::steady_clock::now() + kMatchLimit;
  while (!peer.matched()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(10ms);
  }
  // The other end may be some moments later in knowing us.
  for (int i = 0; i < 20; ++i) {
    peer.publish({steady_ns(), 0});
    std::this_thread::sleep_for(20ms);
  }
  return true;
}

/// CPU time in microseconds for each message after the warm-up.
double send(Peer& peer, std::uint32_t count) {
  double cpu_begin_us = 0.0;
  auto next = std::chrono::steady_clock::now();
  for (std::uint32_t number = 1; number <= kWarmUp + count; ++number) {
    if (number == kWarmUp + 1) cpu_begin_us = cpu_us();
    std::this_thread::sleep_until(next += kPeriod);
    // Who cannot keep the pace is not punished by a queue of its own making.
    next = std::max(next, std::chrono::steady_clock::now() - kPeriod);
    peer.publish({steady_ns(), number});
  }
  return (cpu_us() - cpu_begin_us) / double(count);
}

int run(const PeerOptions& wanted, std::uint32_t count) {
  Recorder recorder(count);
  PeerOptions options = wanted;
  options.on_message = [&recorder](const Mark& mark) { recorder.note(mark); };
  const auto peer = make_peer(options);
  if (peer == nullptr) {
    fmt::print("{{\"skipped\": \"no messages of that size\"}}\n");
    return 0;
  }
  if (options.sends) {
    if (!wait_for_match(*peer)) {
      fmt::print(stderr, "no receiver was found\n");
      return 1;
    }
    const double cpu = send(*peer, count);
    if (!options.receives) {
      fmt::print("{{\"cpu_us\": {:.2f}}}\n", cpu);
      std::fflush(stdout);
      std::this_thread::sleep_for(1s);  // reliable samples on their way
      return 0;
    }
  }
  recorder.wait();
  fmt::print("{{{}}}\n", recorder.report());
  return 0;
}

}  // namespace
}  // namespace swiftlet::bench

int main(int count, char** arguments) {
  using namespace swiftlet::bench;
  if (count == 2 && std::string(arguments[1]) == "variants") {
    for (const std::string& variant : variants()) fmt::print("{}\n", variant);
    return 0;
  }
  const std::string role = count == 5 ? arguments[3] : "";
  if (role != "both" && role != "send" && role != "receive") {
    fmt::print(stderr, "usage: {} VARIANT BYTES both|send|receive COUNT, or: variants\n",
               arguments[0]);
    return 2;
  }
  PeerOptions options;
  options.variant = arguments[1];
  options.bytes = std::size_t(std::atoll(arguments[2]));
  options.sends = role != "receive";
  options.receives = role != "send";
  return run(options, std::uint32_t(std::atoi(arguments[4])));
}
