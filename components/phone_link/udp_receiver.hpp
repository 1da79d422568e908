// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "components/phone_link/pose_datagram.hpp"
#include "components/phone_link/udp_socket.hpp"

namespace swiftlet {

/// Waits for datagrams in a thread of its own, notes when each arrived, and keeps them until they
/// are taken. Of more than `kMost` that wait, the oldest are given up.
class UdpReceiver {
 public:
  static constexpr std::size_t kMost = 64;

  struct Datagram {
    std::array<std::uint8_t, kLongestDatagram + 1> bytes;  // one more, so that too long is seen
    std::size_t size = 0;
    UdpEndpoint sender;
    Time arrival{};
  };

  /// `clock` and `arrived` are called in that thread; `arrived` each time that a datagram waits.
  UdpReceiver(UdpSocket socket, std::function<Time()> clock, std::function<void()> arrived);
  ~UdpReceiver();
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  /// The oldest that waits; false where none does.
  bool take(Datagram& datagram);
  /// How many were given up so far.
  std::uint64_t given_up() const;
  /// Why nothing comes any more; "" while it does.
  std::string failure() const;

 private:
  void run();
  bool wait() const;
  void keep(const Datagram& datagram);

  UdpSocket socket_;
  std::function<Time()> clock_;
  std::function<void()> arrived_;
  int stop_ = -1;  // eventfd
  mutable std::mutex mutex_;
  std::vector<Datagram> ring_;
  std::size_t first_ = 0;
  std::size_t waiting_ = 0;
  std::uint64_t given_up_ = 0;
  std::string failure_;
  std::thread thread_;
};

}  // namespace swiftlet
