// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// One middleware under measurement. Every program of this folder defines make_peer(); the rest is
// the same for all: harness.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace swiftlet::bench {

/// Nanoseconds of the steady clock, which processes of one machine share.
std::int64_t steady_ns();

/// What a message of the measurement carries beside its bytes. All peers send sensor_msgs/Image (or
/// a plain frame): the moment in header.stamp, the number in width.
struct Mark {
  std::int64_t sent_ns = 0;
  std::uint32_t number = 0;
};

inline constexpr std::int64_t kSecond = 1'000'000'000;

struct PeerOptions {
  std::string variant;    ///< one of variants()
  std::size_t bytes = 0;  ///< of image data
  bool sends = false;
  bool receives = false;
  /// To be called in the first line of the receiver's callback.
  std::function<void(const Mark&)> on_message;

  /// Samples that fit into a datagram go reliably, larger ones as images do: best effort.
  bool large() const { return bytes > 60'000; }
  int depth() const { return large() ? 4 : 32; }
};

class Peer {
 public:
  virtual ~Peer() = default;
  /// Sends one message. `mark.sent_ns` is the moment before this call.
  virtual void publish(const Mark& mark) = 0;
  /// Whether the receiver was found.
  virtual bool matched() = 0;
};

/// Ways to use this middleware that are measured.
const std::vector<std::string>& variants();
/// Null where this variant does not send messages of that size.
std::unique_ptr<Peer> make_peer(const PeerOptions& options);

}  // namespace swiftlet::bench
