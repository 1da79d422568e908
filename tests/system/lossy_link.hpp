// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>

namespace swiftlet::test {

/// A wire between two network namespaces that is slow and loses packets: a tun interface at each
/// end, and a thread that carries what goes in at one end to the other, in its order. It ends with
/// this object. Needs root and /dev/net/tun; throws std::system_error where it cannot be made.
class LossyLink {
 public:
  struct End {
    pid_t host;           ///< a process in the namespace
    std::string address;  ///< of the interface, "10.7.0.1/24"
  };
  struct Params {
    double loss = 0.0;                   ///< share of the packets, each way
    std::chrono::milliseconds delay{0};  ///< each way
    std::string interface = "radio0";    ///< its name at both ends
    unsigned seed = 1;
  };

  LossyLink(const std::array<End, 2>& ends, const Params& params);
  ~LossyLink();
  LossyLink(const LossyLink&) = delete;
  LossyLink& operator=(const LossyLink&) = delete;

  /// While it is cut, nothing goes in; what is on its way arrives.
  void cut(bool is_cut) { is_cut_ = is_cut; }
  /// Packets, both ways together.
  std::uint64_t carried() const { return carried_; }
  std::uint64_t lost() const { return lost_; }

 private:
  void carry();

  Params params_;
  std::array<int, 2> interfaces_{-1, -1};
  std::atomic<bool> is_cut_{false};
  std::atomic<bool> ends_{false};
  std::atomic<std::uint64_t> carried_{0};
  std::atomic<std::uint64_t> lost_{0};
  std::thread thread_;
};

}  // namespace swiftlet::test
