// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/rtps_guard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace swiftlet {
namespace {

using testing::HasSubstr;
using testing::StrEq;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kEprosima = 0x0f, kCyclone = 0x10;
constexpr std::uint8_t kReaderEntity[] = {0, 0, 1, 4}, kWriterEntity[] = {0, 0, 1, 3},
                       kBuiltinWriter[] = {0, 1, 0, 0xc2};

/// A datagram, put together submessage by submessage, in either byte order.
class Datagram {
 public:
  explicit Datagram(bool little_endian = true, std::uint8_t vendor = kCyclone)
      : bytes_{'R', 'T', 'P', 'S', 2, 3, 1, vendor}, little_(little_endian) {
    bytes_.resize(20, 0x55);
  }

  Datagram& begin(std::uint8_t id, std::uint8_t flags = 0) {
    length_at_ = bytes_.size() + 2;
    const int order = little_ ? 1 : 0;
    raw({id, static_cast<std::uint8_t>(flags | order), 0, 0});
    return *this;
  }
  /// The length that the last submessage really has, and `more`.
  Datagram& end(int more = 0) {
    const auto length =
        static_cast<std::uint16_t>(static_cast<int>(bytes_.size() - length_at_ - 2) + more);
    const Bytes both = ordered(length, 2);
    std::copy(both.begin(), both.end(), bytes_.begin() + static_cast<long>(length_at_));
    return *this;
  }
  template <class Range>
  Datagram& raw(const Range& bytes) {
    bytes_.insert(bytes_.end(), std::begin(bytes), std::end(bytes));
    return *this;
  }
  Datagram& raw(std::initializer_list<std::uint8_t> bytes) { return raw(Bytes(bytes)); }
  Datagram& half(std::uint64_t value) { return raw(ordered(value, 2)); }
  Datagram& word(std::uint64_t value) { return raw(ordered(value, 4)); }
  Datagram& number(std::uint64_t value) { return word(value >> 32).word(value & 0xFFFFFFFF); }
  Datagram& zeros(std::size_t count) { return raw(Bytes(count, 0)); }

  const Bytes& bytes() const { return bytes_; }

 private:
  Bytes ordered(std::uint64_t value, int size) const {
    Bytes bytes;
    for (int i = 0; i < size; ++i) {
      bytes.push_back(static_cast<std::uint8_t>(value >> (8 * (little_ ? i : size - 1 - i))));
    }
    return bytes;
  }

  Bytes bytes_;
  bool little_;
  std::size_t length_at_ = 0;
};

std::string problem_of(const Datagram& datagram, RtpsGuard&& guard = RtpsGuard()) {
  const char* problem = guard.judge(datagram.bytes().data(), datagram.bytes().size()).problem;
  return problem == nullptr ? "" : problem;
}

Datagram& data(Datagram& datagram, std::uint64_t number, std::uint16_t to_qos = 16) {
  return datagram.begin(0x15, 0x04)
      .half(0)
      .half(to_qos)
      .raw(kReaderEntity)
      .raw(kWriterEntity)
      .number(number)
      .raw({0, 1, 0, 0})
      .zeros(12)
      .end();
}

struct Fragment {
  std::uint64_t first = 1, count = 1, size = 8, sample = 20;
  std::size_t payload = 8;
};
Datagram fragment(const Fragment& f, bool little_endian = true) {
  Datagram datagram(little_endian);
  datagram.begin(0x16)
      .half(0)
      .half(28)
      .raw(kReaderEntity)
      .raw(kWriterEntity)
      .number(1)
      .word(f.first)
      .half(f.count)
      .half(f.size)
      .word(f.sample)
      .zeros(f.payload)
      .end();
  return datagram;
}

Datagram heartbeat(std::uint64_t first, std::uint64_t last, bool little_endian = true) {
  Datagram datagram(little_endian);
  datagram.begin(0x07)
      .raw(kReaderEntity)
      .raw(kWriterEntity)
      .number(first)
      .number(last)
      .word(1)
      .end();
  return datagram;
}

/// ACKNACK, or GAP which has a number before its set.
Datagram with_set(std::uint8_t id, std::uint64_t base, std::uint32_t bits, std::size_t words) {
  Datagram datagram;
  datagram.begin(id).raw(kReaderEntity).raw(kWriterEntity);
  if (id == 0x08) datagram.number(1);
  datagram.number(base).word(bits).zeros(4 * words);
  if (id == 0x06) datagram.word(1);
  return datagram.end();
}

class InEitherOrder : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(RtpsGuard, InEitherOrder, testing::Bool());

TEST_P(InEitherOrder, WhatAllVendorsSendPasses) {
  Datagram datagram(GetParam());
  datagram.begin(0x0e).zeros(12).end();  // INFO_DST
  datagram.begin(0x09).word(1).word(2).end();
  data(datagram, 5);
  datagram.begin(0x07).raw(kReaderEntity).raw(kWriterEntity).number(6).number(5).word(1).end();
  datagram.begin(0x01).end();                    // PAD without a body
  datagram.begin(0x09, 0x02).end();              // INFO_TS without a time
  datagram.begin(0x80).zeros(7).end().zeros(1);  // of another vendor, not a multiple of four
  EXPECT_EQ(problem_of(datagram), "");
  for (const Fragment& f : {Fragment{}, Fragment{3, 1, 8, 20, 4}, Fragment{1, 3, 8, 20, 20}}) {
    EXPECT_EQ(problem_of(fragment(f, GetParam())), "");
  }
  EXPECT_EQ(problem_of(heartbeat(1, 0, GetParam())), "");
}

TEST_P(InEitherOrder, LengthsThatLeaveTheDatagramAreRefused) {
  for (const int more : {1, 4, 1000}) {
    Datagram datagram(GetParam());
    datagram.begin(0x55).zeros(8).end(more);
    EXPECT_EQ(problem_of(datagram), "a submessage that is cut");
  }
  // Of what is cut anywhere, whole submessages remain.
  Datagram whole(GetParam());
  whole.begin(0x09).word(1).word(2).end();
  const std::size_t between = whole.bytes().size();
  data(whole, 5);
  for (std::size_t size = 0; size < whole.bytes().size(); ++size) {
    const Bytes cut(whole.bytes().begin(), whole.bytes().begin() + static_cast<long>(size));
    const RtpsGuard::Verdict verdict = RtpsGuard().judge(cut.data(), cut.size());
    EXPECT_EQ(verdict.problem == nullptr, size == 20 || size >= between) << size;
    if (verdict.problem == nullptr) {
      EXPECT_EQ(verdict.size, size == 20 ? 20 : between);
    }
  }
}

TEST(RtpsGuard, AListOfParametersEndsWithinItsSubmessage) {
  const auto with_qos = [](std::uint16_t length) {
    Datagram datagram;
    datagram.begin(0x15, 0x02 | 0x04)
        .half(0)
        .half(16)
        .raw(kReaderEntity)
        .raw(kWriterEntity)
        .number(1)
        .half(0x70)
        .half(length)
        .zeros(16)
        .half(1)
        .half(0)
        .raw({0, 1, 0, 0})
        .zeros(4)
        .end();
    // Of another submessage, into which the list could run on.
    datagram.begin(0x55).half(1).half(0).zeros(100).end();
    return problem_of(datagram);
  };
  EXPECT_EQ(with_qos(16), "");
  EXPECT_THAT(with_qos(24), HasSubstr("outside"));
  EXPECT_THAT(with_qos(0xffff), HasSubstr("outside"));

  const auto discovery = [](std::uint16_t length, std::uint8_t encapsulation, const auto& writer) {
    Datagram datagram;
    datagram.begin(0x15, 0x04)
        .half(0)
        .half(16)
        .raw(kReaderEntity)
        .raw(writer)
        .number(1)
        .raw({0, encapsulation, 0, 0})
        .half(0x50)
        .half(length)
        .zeros(16)
        .half(1)
        .half(0)
        .end();
    return problem_of(datagram);
  };
  EXPECT_EQ(discovery(16, 3, kBuiltinWriter), "");
  EXPECT_THAT(discovery(20, 3, kBuiltinWriter), HasSubstr("does not end"));
  EXPECT_THAT(discovery(0xffff, 3, kBuiltinWriter), HasSubstr("does not end"));
  // A sample that looks like one is none.
  EXPECT_EQ(discovery(20, 3, kWriterEntity), "");
  EXPECT_EQ(discovery(20, 1, kBuiltinWriter), "");
}

TEST(RtpsGuard, APayloadBeginsBehindTheFixedPartOfItsSubmessage) {
  for (const int offset : {0, 15, 33, 0x7fff, 0xffff}) {
    Datagram datagram;
    data(datagram, 1, static_cast<std::uint16_t>(offset));
    EXPECT_THAT(problem_of(datagram), HasSubstr("outside")) << offset;
  }
  Datagram datagram;
  data(datagram, 1, 20);  // a later version of the protocol may have more before it
  EXPECT_EQ(problem_of(datagram), "");
}

TEST(RtpsGuard, AFragmentLiesInItsSampleAndBringsItsBytes) {
  EXPECT_THAT(problem_of(fragment({0, 1, 8, 20, 8})), HasSubstr("without a fragment"));
  EXPECT_THAT(problem_of(fragment({1, 0, 8, 20, 8})), HasSubstr("without a fragment"));
  EXPECT_THAT(problem_of(fragment({1, 1, 0, 20, 8})), HasSubstr("without a fragment"));
  EXPECT_THAT(problem_of(fragment({4, 1, 8, 20, 8})), HasSubstr("not in its sample"));
  EXPECT_THAT(problem_of(fragment({1, 4, 8, 20, 32})), HasSubstr("not in its sample"));
  EXPECT_THAT(problem_of(fragment({0xffffffff, 1, 8, 20, 8})), HasSubstr("not in its sample"));
  EXPECT_THAT(problem_of(fragment({1, 1, 8, 0xffffffff, 8})), HasSubstr("too large"));
  EXPECT_THAT(problem_of(fragment({1, 17, 8, 200, 136})), HasSubstr("too many"));
  EXPECT_THAT(problem_of(fragment({1, 1, 8, 20, 7})), HasSubstr("payload is cut"));
  EXPECT_THAT(problem_of(fragment({3, 1, 8, 20, 3})), HasSubstr("payload is cut"));
}

TEST(RtpsGuard, SaysWhichDatagramsBringFragments) {
  const auto has_fragments = [](const Datagram& datagram) {
    return RtpsGuard().judge(datagram.bytes().data(), datagram.bytes().size()).has_fragments;
  };
  EXPECT_FALSE(has_fragments(heartbeat(1, 1)));
  EXPECT_TRUE(has_fragments(fragment({}).begin(0x01).end()));
}

TEST(RtpsGuard, SetsHaveAtMost256NumbersAndAreWhole) {
  EXPECT_EQ(problem_of(with_set(0x06, 0, 0, 0)), "");
  EXPECT_EQ(problem_of(with_set(0x06, 7, 256, 8)), "");
  EXPECT_EQ(problem_of(with_set(0x08, 7, 33, 2)), "");
  for (const int kind : {0x06, 0x08}) {
    const auto id = static_cast<std::uint8_t>(kind);
    EXPECT_THAT(problem_of(with_set(id, 7, 257, 9)), HasSubstr("set that is cut"));
    EXPECT_THAT(problem_of(with_set(id, 7, 0xffffffff, 8)), HasSubstr("set that is cut"));
    EXPECT_THAT(problem_of(with_set(id, 7, 65, 2)), HasSubstr("cut"));
  }
}

TEST(RtpsGuard, NumbersAreThoseThatAWriterCanHave) {
  EXPECT_EQ(problem_of(heartbeat(1, 1)), "");
  EXPECT_EQ(problem_of(heartbeat(0, 0)), "a HEARTBEAT of no numbers");
  EXPECT_EQ(problem_of(heartbeat(7, 5)), "a HEARTBEAT of no numbers");
  EXPECT_EQ(problem_of(heartbeat(1, ~0ULL)), "a HEARTBEAT of no numbers");
  EXPECT_EQ(problem_of(heartbeat(1ULL << 62, 1ULL << 62)), "a HEARTBEAT of no numbers");
  Datagram without_number;
  EXPECT_EQ(problem_of(data(without_number, 0)), "a DATA without a number");
  EXPECT_EQ(problem_of(with_set(0x08, 1 << 30, 0, 0)), "a GAP that is too long");
}

TEST(RtpsGuard, OneWriterDoesNotJumpAheadAndOthersDoNotHoldItBack) {
  RtpsGuard guard;
  const auto problem = [&guard](const Datagram& datagram) {
    return guard.judge(datagram.bytes().data(), datagram.bytes().size()).problem;
  };
  ASSERT_EQ(problem(heartbeat(1, 10)), nullptr);
  EXPECT_THAT(problem(heartbeat(1 << 24, 1 << 24)), StrEq("a sequence number that is far ahead"));
  EXPECT_EQ(problem(heartbeat(5, 11)), nullptr);
  // The same entity of another participant, named by INFO_SRC.
  Datagram other;
  other.begin(0x0c).zeros(20).end();
  data(other, 1 << 24);
  EXPECT_EQ(problem(other), nullptr);
}

TEST(RtpsGuard, StatisticsOfFastDdsStandAtTheEnd) {
  const auto statistics = [](std::uint8_t vendor, bool last) {
    Datagram datagram(true, vendor);
    datagram.begin(0x80).zeros(56).end();
    if (!last) datagram.begin(0x09).word(1).word(2).end();
    return problem_of(datagram);
  };
  EXPECT_EQ(statistics(kEprosima, true), "");
  EXPECT_EQ(statistics(kEprosima, false), "statistics that are not at the end");
  EXPECT_EQ(statistics(kCyclone, false), "");
}

TEST(PlausibleSequence, ANumberFarAheadIsBelievedWhenManyInARowAgree) {
  PlausibleSequence watch;
  const WriterGuid writer{1, 2, 3};
  constexpr std::uint64_t kFar = PlausibleSequence::kWindow * 100;
  EXPECT_TRUE(watch.accept(writer, 5));
  EXPECT_TRUE(watch.accept(writer, 5 + PlausibleSequence::kWindow));
  EXPECT_TRUE(watch.accept(writer, 3)) << "one that comes late";
  // Now and then one that is far ahead is never believed ...
  for (std::uint64_t i = 0; i < 1000; ++i) {
    EXPECT_FALSE(watch.accept(writer, kFar));
    EXPECT_TRUE(watch.accept(writer, 6 + i));
  }
  // ... nor are many that do not agree ...
  for (std::uint64_t i = 1; i < 100; ++i) EXPECT_FALSE(watch.accept(writer, kFar * i));
  // ... but a writer that was out of reach for long is.
  int refused = 0;
  for (std::uint64_t i = 0; i < 100 && !watch.accept(writer, kFar + i); ++i) ++refused;
  EXPECT_EQ(refused, PlausibleSequence::kAgreeing - 1);
  EXPECT_TRUE(watch.accept(writer, kFar + 1000));
}

TEST(PlausibleSize, ALargeSampleIsBelievedWhenItsFragmentsAgree) {
  PlausibleSize watch;
  const WriterGuid writer{1, 2, 3};
  constexpr std::uint32_t kLarge = 3 * PlausibleSize::kAlwaysBelieved;
  EXPECT_TRUE(watch.accept(writer, 1, PlausibleSize::kAlwaysBelieved));
  // Now and then a damaged one, of another sample or with another size, never is ...
  for (std::uint32_t i = 0; i < 1000; ++i) {
    EXPECT_FALSE(watch.accept(writer, i, kLarge));
    EXPECT_FALSE(watch.accept(writer, i, kLarge + 1));
    EXPECT_TRUE(watch.accept(writer, i, 1000));
  }
  // ... a sample whose fragments all say so is, and with it the next ones of its writer ...
  int refused = 0;
  while (refused < 100 && !watch.accept(writer, 2000, kLarge)) ++refused;
  EXPECT_EQ(refused, PlausibleSize::kAgreeing - 1);
  EXPECT_TRUE(watch.accept(writer, 2001, kLarge));
  EXPECT_TRUE(watch.accept(writer, 2002, kLarge + kLarge / 2)) << "images differ in size";
  // ... but not those of another writer.
  EXPECT_FALSE(watch.accept({4, 5, 6}, 2003, kLarge));
}

TEST(RtpsGuard, ASingleFragmentCannotClaimMuchMemory) {
  RtpsGuard guard;
  const auto problem = [&guard](const Datagram& datagram) {
    return guard.judge(datagram.bytes().data(), datagram.bytes().size()).problem;
  };
  constexpr std::uint32_t kLarge = PlausibleSize::kAlwaysBelieved + 1;
  EXPECT_EQ(problem(fragment({1, 1, 8, PlausibleSize::kAlwaysBelieved, 8})), nullptr);
  EXPECT_THAT(problem(fragment({1, 1, 8, kLarge, 8})), HasSubstr("larger than any before"));
  for (int i = 2; i < PlausibleSize::kAgreeing; ++i) (void)problem(fragment({1, 1, 8, kLarge, 8}));
  EXPECT_EQ(problem(fragment({1, 1, 8, kLarge, 8})), nullptr);
}

}  // namespace
}  // namespace swiftlet
