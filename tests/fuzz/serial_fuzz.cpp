// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Bytes of a serial line at `serial_link`: as they are, and between sound frames.
#include "components/serial_link/link_frame.hpp"

#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace swiftlet;

void decode_all(const std::uint8_t* data, std::size_t size) {
  FrameDecoder decoder;
  const std::size_t before = fuzz::allocated();
  std::size_t allowed = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const LinkFrame* frame = decoder.take(data[i]);
    if (frame == nullptr) continue;
    fuzz::demand(frame->payload.size() <= kMaxPayload, "a frame has its limit");
    const std::size_t own = fuzz::allocated();
    const auto bytes = encode(*frame);
    FrameDecoder again;
    const LinkFrame* same = nullptr;
    for (const std::uint8_t byte : bytes) same = again.take(byte);
    fuzz::demand(same != nullptr, "what was taken is taken again");
    fuzz::demand(same->payload == frame->payload && same->sequence == frame->sequence &&
                     same->type == frame->type,
                 "and is the same");
    allowed += fuzz::allocated() - own;
  }
  fuzz::demand(fuzz::allocated() - before == allowed, "the decoder takes no memory");
}

/// Whatever comes before and after, a sound frame is found.
void surround(const std::uint8_t* data, std::size_t size) {
  const LinkFrame frame{FrameType::kCommand, 7, {data, data + (size < 100 ? size : 100)}};
  const auto bytes = encode(frame);
  FrameDecoder decoder;
  for (std::size_t i = 0; i < size; ++i) decoder.take(data[i]);
  const LinkFrame* found = nullptr;
  for (const std::uint8_t byte : bytes) found = decoder.take(byte);
  fuzz::demand(found != nullptr && found->payload == frame.payload, "a sound frame is found");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  decode_all(data, size);
  surround(data, size);
  return 0;
}
