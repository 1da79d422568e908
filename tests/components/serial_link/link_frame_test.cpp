// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/serial_link/link_frame.hpp"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "components/serial_link/sequence_watch.hpp"

namespace swiftlet {
namespace {

using Bytes = std::vector<std::uint8_t>;

LinkFrame random_frame(std::mt19937& random, std::size_t size) {
  LinkFrame frame;
  frame.type = static_cast<FrameType>(random() % 4);
  frame.sequence = static_cast<std::uint16_t>(random());
  // Every third byte a zero, now and then none or all of them.
  const unsigned zeros = random() % 4;
  for (std::size_t i = 0; i < size; ++i) {
    const bool zero = zeros == 3 || (zeros > 0 && random() % 3 == 0);
    frame.payload.push_back(zero ? 0 : static_cast<std::uint8_t>(1 + random() % 255));
  }
  return frame;
}

bool same(const LinkFrame& a, const LinkFrame& b) {
  return a.type == b.type && a.sequence == b.sequence && a.payload == b.payload;
}

std::vector<LinkFrame> decode(FrameDecoder& decoder, const Bytes& bytes) {
  std::vector<LinkFrame> frames;
  for (const std::uint8_t byte : bytes) {
    if (const LinkFrame* frame = decoder.take(byte)) frames.push_back(*frame);
  }
  return frames;
}

void append(Bytes& bytes, const Bytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

TEST(LinkFrame, ComesBackAsItWasForEachLengthAndAnyContent) {
  std::mt19937 random(1);
  FrameDecoder decoder;
  for (std::size_t size = 0; size <= kMaxPayload; ++size) {
    for (int k = 0; k < 20; ++k) {
      const LinkFrame frame = random_frame(random, size);
      const Bytes bytes = encode(frame);
      ASSERT_EQ(bytes.size(), frame_bytes(size));
      ASSERT_LE(bytes.size(), kMaxFrameBytes);
      for (std::size_t i = 1; i + 1 < bytes.size(); ++i) ASSERT_NE(bytes[i], 0) << i;
      const auto frames = decode(decoder, bytes);
      ASSERT_EQ(frames.size(), 1u) << size;
      ASSERT_TRUE(same(frames[0], frame)) << size;
    }
  }
  EXPECT_EQ(decoder.counts().damaged, 0u);
  EXPECT_THROW(encode(random_frame(random, kMaxPayload + 1)), std::length_error);
}

TEST(LinkFrame, HasTheBytesThatAreWrittenDown) {
  // type 1, sequence 0x0200, payload 11 00, CRC-32 of 01 00 02 11 00.
  LinkFrame frame{FrameType::kTelemetry, 0x0200, {0x11, 0x00}};
  const Bytes bytes = encode(frame);
  const Bytes beginning(bytes.begin(), bytes.begin() + 6);
  EXPECT_EQ(beginning, (Bytes{0x00, 0x02, 0x01, 0x03, 0x02, 0x11}));
  EXPECT_EQ(bytes.size(), 12u);
  EXPECT_EQ(bytes.back(), 0x00);
}

/// Frames as they are and with up to two wrong bits, anywhere, the zeros around them included:
/// what comes out is what went in, or nothing.
TEST(FrameDecoder, RefusesEachSingleAndDoubleBitError) {
  std::mt19937 random(2);
  std::size_t errors = 0;
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, std::size_t{20}, std::size_t{120}}) {
    const LinkFrame frame = random_frame(random, size);
    const Bytes bytes = encode(frame);
    const std::size_t bits = 8 * bytes.size();
    const auto try_out = [&](std::size_t a, std::size_t b) {
      Bytes damaged = bytes;
      damaged[a / 8] ^= static_cast<std::uint8_t>(1U << (a % 8));
      if (b != a) damaged[b / 8] ^= static_cast<std::uint8_t>(1U << (b % 8));
      damaged.push_back(0);
      FrameDecoder decoder;
      // Damage to the zero at the beginning alone, or to what comes after the frame, harms nothing.
      for (const LinkFrame& got : decode(decoder, damaged)) ASSERT_TRUE(same(got, frame));
      const bool inside = a >= 8 && b >= 8 && a < bits - 8 && b < bits - 8;
      if (inside) {
        ASSERT_EQ(decoder.counts().frames, 0u) << a << " " << b;
      }
      ++errors;
    };
    for (std::size_t a = 0; a < bits; ++a) {
      for (std::size_t b = a; b < bits; ++b) try_out(a, b);
    }
  }
  EXPECT_GT(errors, 500'000u);
}

TEST(FrameDecoder, RefusesBurstsAndRandomDamageInLongFrames) {
  std::mt19937 random(3);
  for (int k = 0; k < 200'000; ++k) {
    const LinkFrame frame = random_frame(random, random() % (kMaxPayload + 1));
    Bytes bytes = encode(frame);
    const std::size_t first = 1 + random() % (bytes.size() - 2);
    const std::size_t length = 1 + random() % 8;
    bool changed = false;
    for (std::size_t i = first; i < std::min(first + length, bytes.size() - 1); ++i) {
      const auto noise = static_cast<std::uint8_t>(random());
      changed = changed || noise != 0;
      bytes[i] ^= noise;
    }
    FrameDecoder decoder;
    const auto frames = decode(decoder, bytes);
    if (changed) {
      ASSERT_TRUE(frames.empty()) << k;
    }
  }
}

TEST(FrameDecoder, RefusesWhatWasCutAndReadsWhatFollows) {
  std::mt19937 random(4);
  for (int k = 0; k < 2'000; ++k) {
    const LinkFrame lost = random_frame(random, random() % 100);
    const LinkFrame next = random_frame(random, random() % 100);
    Bytes bytes = encode(lost);
    bytes.resize(random() % (bytes.size() - 1));  // at least its end is missing
    append(bytes, encode(next));
    FrameDecoder decoder;
    const auto frames = decode(decoder, bytes);
    ASSERT_EQ(frames.size(), 1u);
    ASSERT_TRUE(same(frames[0], next));
  }
}

TEST(FrameDecoder, FindsEachFrameBetweenAnyGarbage) {
  std::mt19937 random(5);
  FrameDecoder decoder;
  std::size_t found = 0;
  for (int k = 0; k < 5'000; ++k) {
    Bytes bytes;
    for (std::size_t n = random() % 2000; n > 0; --n) {
      bytes.push_back(static_cast<std::uint8_t>(random()));
    }
    const LinkFrame frame = random_frame(random, random() % (kMaxPayload + 1));
    append(bytes, encode(frame));
    append(bytes, encode(frame));  // two zeros between them
    for (const LinkFrame& got : decode(decoder, bytes)) {
      ASSERT_TRUE(same(got, frame));
      ++found;
    }
  }
  EXPECT_EQ(found, 10'000u);
  EXPECT_GT(decoder.counts().damaged, 5'000u);
}

TEST(FrameDecoder, FramesMayShareTheZeroBetweenThem) {
  std::mt19937 random(6);
  Bytes bytes;
  for (int k = 0; k < 100; ++k) {
    const Bytes next = encode(random_frame(random, 30));
    bytes.insert(bytes.end(), next.begin() + (k == 0 ? 0 : 1), next.end());
  }
  FrameDecoder decoder;
  EXPECT_EQ(decode(decoder, bytes).size(), 100u);
  EXPECT_EQ(decoder.counts().damaged, 0u);
}

TEST(FrameDecoder, ALineThatWasCutBeginsAnew) {
  FrameDecoder decoder;
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(decoder.take(7), nullptr);
  decoder.reset();
  const Bytes bytes = encode({FrameType::kHello, 9, {}});
  EXPECT_EQ(decode(decoder, Bytes(bytes.begin() + 1, bytes.end())).size(), 1u);
}

TEST(SequenceWatch, CountsWhatIsMissing) {
  SequenceWatch watch;
  for (const int sequence : {65533, 65534, 1, 2}) {
    watch.heard(static_cast<std::uint16_t>(sequence));
  }
  EXPECT_EQ(watch.lost(), 2u) << "65535 and 0";
  watch.heard(40'000);
  EXPECT_EQ(watch.lost(), 2u) << "a sender that began anew";
  watch.heard(40'000);
  EXPECT_EQ(watch.lost(), 2u) << "the same again";
  watch.heard(40'011);
  EXPECT_EQ(watch.lost(), 12u);
}

}  // namespace
}  // namespace swiftlet
