// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/serial_link/link_frame.hpp"

#include <zlib.h>

#include <algorithm>
#include <stdexcept>

namespace swiftlet {
namespace {

std::uint32_t crc_of(const std::uint8_t* bytes, std::size_t size) {
  return static_cast<std::uint32_t>(crc32(0, bytes, static_cast<uInt>(size)));
}

std::uint8_t byte_of(std::uint32_t value, int index) {
  return static_cast<std::uint8_t>(value >> (8 * index));
}

/// Replaces each zero by the distance to the next. At most 254 bytes: no code of a full block is
/// needed but that of the last one.
std::vector<std::uint8_t> without_zeros(const std::vector<std::uint8_t>& bytes) {
  std::vector<std::uint8_t> coded{0};
  coded.reserve(bytes.size() + 1);
  std::size_t code_at = 0;
  for (const std::uint8_t byte : bytes) {
    if (byte != 0) {
      coded.push_back(byte);
      continue;
    }
    coded[code_at] = static_cast<std::uint8_t>(coded.size() - code_at);
    code_at = coded.size();
    coded.push_back(0);
  }
  coded[code_at] = static_cast<std::uint8_t>(coded.size() - code_at);
  return coded;
}

/// Puts the zeros back in place: the bytes begin at `bytes + 1` then. False where that was no COBS.
bool put_zeros_back(std::uint8_t* bytes, std::size_t size) {
  std::size_t at = 0;
  while (at < size) {
    const std::size_t next = at + bytes[at];
    if (next == at || next > size) return false;
    bytes[at] = 0;
    at = next;
  }
  return at == size;
}

}  // namespace

std::vector<std::uint8_t> encode(const LinkFrame& frame) {
  if (frame.payload.size() > kMaxPayload) {
    throw std::length_error("a frame of the serial link carries 247 bytes at most");
  }
  std::vector<std::uint8_t> plain{static_cast<std::uint8_t>(frame.type), byte_of(frame.sequence, 0),
                                  byte_of(frame.sequence, 1)};
  plain.insert(plain.end(), frame.payload.begin(), frame.payload.end());
  const std::uint32_t crc = crc_of(plain.data(), plain.size());
  for (int i = 0; i < 4; ++i) plain.push_back(byte_of(crc, i));
  const std::vector<std::uint8_t> coded = without_zeros(plain);
  std::vector<std::uint8_t> wire{0};
  wire.insert(wire.end(), coded.begin(), coded.end());
  wire.push_back(0);
  return wire;
}

FrameDecoder::FrameDecoder() {
  frame_.payload.reserve(kMaxPayload);
}

void FrameDecoder::reset() {
  size_ = 0;
}

const LinkFrame* FrameDecoder::take(std::uint8_t byte) {
  ++counts_.bytes;
  if (byte != 0) {
    if (size_ < raw_.size()) raw_[size_] = byte;
    size_ = std::min(size_ + 1, raw_.size() + 1);
    return nullptr;
  }
  if (size_ == 0) return nullptr;  // between two frames
  const bool sound = decode();
  size_ = 0;
  ++(sound ? counts_.frames : counts_.damaged);
  return sound ? &frame_ : nullptr;
}

bool FrameDecoder::decode() {
  if (size_ > raw_.size() || size_ < kFrameOverhead + 1) return false;
  if (!put_zeros_back(raw_.data(), size_)) return false;
  const std::uint8_t* plain = raw_.data() + 1;
  const std::size_t size = size_ - 1;
  const std::size_t covered = size - 4;
  std::uint32_t crc = 0;
  for (std::size_t i = 0; i < 4; ++i) crc |= std::uint32_t{plain[covered + i]} << (8 * i);
  if (crc != crc_of(plain, covered)) return false;
  frame_.type = static_cast<FrameType>(plain[0]);
  frame_.sequence = static_cast<std::uint16_t>(plain[1] | (plain[2] << 8));
  frame_.payload.assign(plain + 3, plain + covered);
  return true;
}

}  // namespace swiftlet
