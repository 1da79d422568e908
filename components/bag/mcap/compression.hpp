// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "components/bag/mcap/bytes.hpp"
#include "estimation/basics/result.hpp"

namespace swiftlet::mcap {

enum class Compression { kNone, kLz4, kZstd };

/// What a Chunk record calls it: "", "lz4", "zstd".
const char* name_of(Compression compression);

/// Compresses `raw` into one frame of the algorithm (LZ4 frame format, Zstandard level 1).
/// `compressed` is overwritten. kNone copies.
Status compress(Compression compression, ByteView raw, Bytes& compressed);

/// Decompresses into `raw`, which must become exactly `size` bytes. Memory follows what really
/// comes out, never what a hostile header promises. `compression` is the text of the Chunk.
Status decompress(const std::string& compression, ByteView compressed, std::uint64_t size,
                  Bytes& raw);

}  // namespace swiftlet::mcap
