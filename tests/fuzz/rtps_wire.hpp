// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// RTPS datagrams: what is heard on the loopback interface, and what is made of it.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "tests/fuzz/mutation.hpp"

namespace swiftlet::fuzz {

/// Hears all RTPS datagrams on the loopback interface of this thread's network. Needs root.
class LoopbackCapture {
 public:
  /// ok() is false where the system does not allow it.
  LoopbackCapture();
  ~LoopbackCapture();
  LoopbackCapture(const LoopbackCapture&) = delete;
  LoopbackCapture& operator=(const LoopbackCapture&) = delete;

  bool ok() const { return socket_ >= 0; }
  /// All datagrams that came since the last call, and at most some thousand.
  std::vector<Bytes> take();

 private:
  int socket_ = -1;
};

/// Makes malformed datagrams of sound ones.
class RtpsMutator {
 public:
  /// Keeps of datagrams that look alike a few, of each sender.
  explicit RtpsMutator(const std::vector<Bytes>& heard);

  std::size_t sound() const { return sound_.size(); }
  /// A sound datagram with some bytes changed, or one with submessages of several, whose headers
  /// may lie. The same `random` gives the same bytes.
  Bytes next(std::mt19937& random) const;

 private:
  struct Submessage {
    Bytes bytes;   ///< with its header of four bytes
    Bytes header;  ///< of the datagram that it came in
  };
  Bytes composed(std::mt19937& random) const;

  std::vector<Bytes> sound_;
  std::vector<Submessage> submessages_;
};

/// Sends to UDP ports of this machine.
class DatagramSender {
 public:
  DatagramSender();
  ~DatagramSender();
  DatagramSender(const DatagramSender&) = delete;
  DatagramSender& operator=(const DatagramSender&) = delete;

  /// `address` in host order.
  void send(const Bytes& bytes, std::uint32_t address, int port) const;

 private:
  int socket_ = -1;
};

}  // namespace swiftlet::fuzz
