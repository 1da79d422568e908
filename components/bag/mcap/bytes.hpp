// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace swiftlet::mcap {

using Bytes = std::vector<std::uint8_t>;

/// Bytes that belong to somebody else. (C++17 has no std::span.)
struct ByteView {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;

  ByteView() = default;
  ByteView(const std::uint8_t* bytes, std::size_t count) : data(bytes), size(count) {}
  ByteView(const Bytes& bytes)  // NOLINT(google-explicit-constructor)
      : data(bytes.data()), size(bytes.size()) {}
  ByteView(std::string_view text)  // NOLINT(google-explicit-constructor)
      : data(reinterpret_cast<const std::uint8_t*>(text.data())), size(text.size()) {}

  /// Both must lie inside this view.
  ByteView part(std::size_t offset, std::size_t count) const { return {data + offset, count}; }
  Bytes copy() const { return {data, data + size}; }
};

/// CRC-32 as zlib and MCAP define it; `crc` continues an earlier one.
std::uint32_t crc32(ByteView bytes, std::uint32_t crc = 0);

}  // namespace swiftlet::mcap
