// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/mcap/compression.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

namespace swiftlet::mcap {
namespace {

constexpr int kZstdLevel = 1;
constexpr std::size_t kFirstOutput = 4 << 20;

/// Room for more output: doubles, up to one byte beyond `size`, which tells too much output from
/// just enough.
void grow(Bytes& raw, std::uint64_t size) {
  const std::uint64_t wanted = raw.empty() ? kFirstOutput : std::uint64_t{2} * raw.size();
  raw.resize(static_cast<std::size_t>(std::min(wanted, size + 1)));
}

Status check_size(std::uint64_t produced, std::uint64_t size) {
  if (produced == size) return {};
  return Error{"decompresses to " + std::string(produced > size ? "more than " : "only ") +
               std::to_string(std::min(produced, size)) + " bytes where its header promises " +
               std::to_string(size)};
}

/// Runs `step(out, room, in, left)`, which returns how much it produced and consumed and whether
/// the frame ended, until the input is used up.
struct Step {
  std::size_t produced = 0;
  std::size_t consumed = 0;
  bool frame_ended = false;
  const char* error = nullptr;
};

template <class StepFunction>
Status stream(ByteView compressed, std::uint64_t size, Bytes& raw, StepFunction&& step) {
  raw.clear();
  std::size_t produced = 0;
  std::size_t consumed = 0;
  bool frame_ended = false;
  for (;;) {
    if (produced == raw.size()) grow(raw, size);
    const Step done = step(raw.data() + produced, raw.size() - produced, compressed.data + consumed,
                           compressed.size - consumed);
    if (done.error != nullptr) return Error{std::string("does not decompress: ") + done.error};
    produced += done.produced;
    consumed += done.consumed;
    frame_ended = done.frame_ended;
    if (produced > size) return check_size(produced, size);
    const bool stuck = done.produced == 0 && done.consumed == 0;
    if (stuck || (frame_ended && consumed == compressed.size)) break;
  }
  raw.resize(produced);
  if (!frame_ended) return Error{"does not decompress: its last frame is not complete"};
  return check_size(produced, size);
}

Status decompress_zstd(ByteView compressed, std::uint64_t size, Bytes& raw) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(),
                                                                     &ZSTD_freeDCtx);
  if (!context) return Error{"does not decompress: out of memory"};
  return stream(compressed, size, raw,
                [&](std::uint8_t* out, std::size_t room, const std::uint8_t* in, std::size_t left) {
                  ZSTD_outBuffer output{out, room, 0};
                  ZSTD_inBuffer input{in, left, 0};
                  const std::size_t hint = ZSTD_decompressStream(context.get(), &output, &input);
                  Step step{output.pos, input.pos, hint == 0, nullptr};
                  if (ZSTD_isError(hint) != 0) step.error = ZSTD_getErrorName(hint);
                  return step;
                });
}

Status decompress_lz4(ByteView compressed, std::uint64_t size, Bytes& raw) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0) {
    return Error{"does not decompress: out of memory"};
  }
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      made, &LZ4F_freeDecompressionContext);
  return stream(compressed, size, raw,
                [&](std::uint8_t* out, std::size_t room, const std::uint8_t* in, std::size_t left) {
                  const std::size_t hint =
                      LZ4F_decompress(context.get(), out, &room, in, &left, nullptr);
                  Step step{room, left, hint == 0, nullptr};
                  if (LZ4F_isError(hint) != 0) step.error = LZ4F_getErrorName(hint);
                  return step;
                });
}

}  // namespace

const char* name_of(Compression compression) {
  switch (compression) {
    case Compression::kLz4:
      return "lz4";
    case Compression::kZstd:
      return "zstd";
    case Compression::kNone:
      break;
  }
  return "";
}

Status compress(Compression compression, ByteView raw, Bytes& compressed) {
  if (compression == Compression::kNone) {
    compressed = raw.copy();
    return {};
  }
  if (compression == Compression::kZstd) {
    compressed.resize(ZSTD_compressBound(raw.size));
    const std::size_t size =
        ZSTD_compress(compressed.data(), compressed.size(), raw.data, raw.size, kZstdLevel);
    if (ZSTD_isError(size) != 0) return Error{std::string("zstd: ") + ZSTD_getErrorName(size)};
    compressed.resize(size);
    return {};
  }
  LZ4F_preferences_t preferences{};
  preferences.frameInfo.contentSize = raw.size;
  compressed.resize(LZ4F_compressFrameBound(raw.size, &preferences));
  const std::size_t size =
      LZ4F_compressFrame(compressed.data(), compressed.size(), raw.data, raw.size, &preferences);
  if (LZ4F_isError(size) != 0) return Error{std::string("lz4: ") + LZ4F_getErrorName(size)};
  compressed.resize(size);
  return {};
}

Status decompress(const std::string& compression, ByteView compressed, std::uint64_t size,
                  Bytes& raw) {
  if (compression.empty()) {
    raw.clear();
    if (const Status same = check_size(compressed.size, size); !same.ok()) return same;
    raw = compressed.copy();
    return {};
  }
  if (compressed.size == 0 && size == 0) {
    raw.clear();
    return {};
  }
  if (compression == "zstd") return decompress_zstd(compressed, size, raw);
  if (compression == "lz4") return decompress_lz4(compressed, size, raw);
  return Error{"is compressed with \"" + compression +
               "\", which is none of zstd, lz4 and no compression"};
}

}  // namespace swiftlet::mcap
