// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace swiftlet {

/// What a frame carries. Numbers on the wire: never reused.
enum class FrameType : std::uint8_t {
  kHello = 0,            ///< nothing: the sender is there
  kTelemetry = 1,        ///< swiftlet_msgs/Telemetry
  kCommand = 2,          ///< swiftlet_msgs/ModeCommand
  kAcknowledgement = 3,  ///< swiftlet_msgs/CommandAck
};

/// One message on a serial line. On the wire:
///
///     0x00 | COBS( type u8 | sequence u16 | payload | CRC-32 u32 of all before ) | 0x00
///
/// little-endian. COBS (Cheshire and Baker 1999) takes all zeros out for one byte more, so that a
/// zero is always the end of a frame: whatever came before, what follows is read again. The zero at
/// the beginning keeps noise on an idle line apart from the frame. The CRC is that of IEEE 802.3.
struct LinkFrame {
  FrameType type = FrameType::kHello;
  std::uint16_t sequence = 0;  ///< counts the frames of this sender, all types together
  std::vector<std::uint8_t> payload;
};

/// Type, sequence and CRC.
inline constexpr std::size_t kFrameOverhead = 7;
/// What COBS holds in one block.
inline constexpr std::size_t kMaxPayload = 254 - kFrameOverhead;
/// With the byte that COBS adds, and the zeros around.
inline constexpr std::size_t kMaxFrameBytes = 254 + 1 + 2;
/// Bytes on the wire.
constexpr std::size_t frame_bytes(std::size_t payload) {
  return payload + kFrameOverhead + 3;
}

/// The frame as it goes over the wire. The payload is at most `kMaxPayload`; throws
/// std::length_error where it is not.
std::vector<std::uint8_t> encode(const LinkFrame& frame);

/// Finds frames in a stream of bytes that may be damaged, cut or no frames at all.
class FrameDecoder {
 public:
  struct Counts {
    std::uint64_t frames = 0;
    std::uint64_t damaged = 0;  ///< what stood between zeros and was no frame
    std::uint64_t bytes = 0;
  };

  FrameDecoder();

  /// Takes one byte. The frame that it completes, valid until the next call; null where there is
  /// none. Takes no memory.
  const LinkFrame* take(std::uint8_t byte);
  /// Forgets what came of a frame: the line was cut.
  void reset();
  const Counts& counts() const { return counts_; }

 private:
  bool decode();

  std::array<std::uint8_t, kMaxFrameBytes - 2> raw_{};
  std::size_t size_ = 0;  // of raw_; beyond it where too much came for a frame
  LinkFrame frame_;
  Counts counts_;
};

}  // namespace swiftlet
