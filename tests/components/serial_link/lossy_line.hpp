// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "tests/components/serial_link/pty_pair.hpp"

namespace swiftlet::test {

/// Adds up for how long a thread that should run every few milliseconds did not: where the machine
/// is busy with other things, that time is not the link's.
class Pauses {
 public:
  void tick() {
    const auto now = std::chrono::steady_clock::now();
    const double gap = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    if (gap > kUsual) total_ = total_ + gap;
  }
  double total_s() const { return total_; }

 private:
  static constexpr double kUsual = 0.04;  // [s]
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::atomic<double> total_{0.0};
};

/// A line between two serial devices that carries no more than so many bytes a second in each
/// direction, and does to them what radios do.
class LossyLine {
 public:
  explicit LossyLine(double bytes_per_s = 1920.0)
      : bytes_per_s_(bytes_per_s), thread_([this] { run(); }) {}
  ~LossyLine() {
    stop_ = true;
    thread_.join();
  }

  const std::string& vehicle() const { return vehicle_.device(); }
  const std::string& ground() const { return ground_.device(); }

  Pauses pauses;
  std::atomic<bool> cut{false};           ///< nothing arrives
  std::atomic<double> lost{0.0};          ///< probability of each byte to be left out
  std::atomic<double> damaged{0.0};       ///< probability of each byte to be another
  std::atomic<std::uint64_t> carried{0};  ///< bytes, towards the ground

 private:
  using Bytes = std::vector<std::uint8_t>;

  void run() {
    auto last = std::chrono::steady_clock::now();
    double down = 0.0;
    double up = 0.0;
    while (!stop_) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));  // the time that bytes take
      pauses.tick();
      const auto now = std::chrono::steady_clock::now();
      const double room = bytes_per_s_ * std::chrono::duration<double>(now - last).count();
      last = now;
      carried += pass(vehicle_, ground_, down += room);
      pass(ground_, vehicle_, up += room);
    }
  }

  std::uint64_t pass(const PtyPair& from, const PtyPair& to, double& room) {
    const Bytes bytes = from.take(static_cast<std::size_t>(room));
    room = std::min(room - static_cast<double>(bytes.size()), kFifo);
    if (!cut) to.put(impaired(bytes));
    return bytes.size();
  }

  Bytes impaired(const Bytes& bytes) {
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    Bytes arrived;
    for (const std::uint8_t byte : bytes) {
      if (chance(random_) < lost) continue;
      const bool hit = chance(random_) < damaged;
      arrived.push_back(hit ? static_cast<std::uint8_t>(random_()) : byte);
    }
    return arrived;
  }

  static constexpr double kFifo = 16.0;  // bytes that a line that was idle takes at once

  double bytes_per_s_;
  PtyPair vehicle_;
  PtyPair ground_;
  std::mt19937 random_{17};
  std::atomic<bool> stop_{false};
  std::thread thread_;  // last: it uses the others
};

}  // namespace swiftlet::test
