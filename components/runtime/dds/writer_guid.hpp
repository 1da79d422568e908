// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>

namespace swiftlet {

/// Of an RTPS writer, as it is in its messages.
using WriterGuid = std::array<std::uint8_t, 16>;

/// Where what is known of a writer is kept, in a table that has no more than `entries` places.
inline std::size_t place_of(const WriterGuid& writer, std::size_t entries) {
  const std::string_view key(reinterpret_cast<const char*>(writer.data()), writer.size());
  return std::hash<std::string_view>()(key) % entries;
}

}  // namespace swiftlet
