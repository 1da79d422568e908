// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "components/phone_link/udp_endpoint.hpp"
#include "estimation/basics/result.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

/// A UDP socket over IPv4, closed with this object.
class UdpSocket {
 public:
  struct Arrival {
    std::size_t size = 0;  ///< of the datagram; more than the room for it where it was cut off
    UdpEndpoint sender;
    Duration waited{};  ///< since the kernel had it
  };

  /// Listens where no other socket does.
  static Result<UdpSocket> listen(const UdpEndpoint& local);
  /// Only sends, from a port of its own.
  static Result<UdpSocket> open();

  UdpSocket(UdpSocket&& other) noexcept;
  UdpSocket& operator=(UdpSocket&& other) noexcept;
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;
  ~UdpSocket();

  int descriptor() const { return descriptor_; }
  /// Does not wait: a size of 0 from port 0 where nothing has come.
  Result<Arrival> receive(std::uint8_t* bytes, std::size_t room);
  /// Done also where nobody listens at the other end.
  Status send(const std::uint8_t* bytes, std::size_t size, const UdpEndpoint& to);

 private:
  explicit UdpSocket(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

}  // namespace swiftlet
