// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/rtps_guard.hpp"

#include <algorithm>
#include <cstring>

namespace swiftlet {
namespace {

constexpr std::size_t kHeader = 20;  // "RTPS", version, vendor, GUID prefix
constexpr std::size_t kPrefix = 12;  // of the GUIDs of a participant
constexpr std::size_t kSubmessageHeader = 4;
constexpr std::size_t kEncapsulation = 4;
constexpr std::uint32_t kMostBits = 256;  // of a set of numbers: 9.4.2.6, 9.4.2.8
/// Above what any sample has, below what hurts.
constexpr std::uint32_t kLargestSample = 64U << 20;
/// A reader goes through a gap number by number.
constexpr std::uint64_t kLongestGap = PlausibleSequence::kWindow;
/// 35 years at 1 kHz; sums with it do not overflow.
constexpr std::uint64_t kLastSequenceNumber = std::uint64_t{1} << 40;

enum Submessage : std::uint8_t {
  kPad = 0x01,
  kAckNack = 0x06,
  kHeartbeat = 0x07,
  kGap = 0x08,
  kInfoTimestamp = 0x09,
  kInfoSource = 0x0c,
  kInfoDestination = 0x0e,
  kNackFragments = 0x12,
  kHeartbeatFragment = 0x13,
  kData = 0x15,
  kDataFragment = 0x16,
  kStatistics = 0x80,  // of eProsima, at the end of a datagram
};

enum Flag : std::uint8_t {
  kLittleEndian = 0x01,
  kInvalidate = 0x02,  // of a timestamp
  kInlineQos = 0x02,
  kHasData = 0x04,
  kHasKey = 0x08,
};

constexpr std::uint8_t kBuiltin = 0xc0;  // kind of an entity of the protocol itself
constexpr std::uint8_t kParameterListBig = 0x02;
constexpr std::uint8_t kParameterListLittle = 0x03;
constexpr std::uint16_t kSentinel = 0x0001;

/// Numbers of a submessage in its own byte order. Reads only what is known to be there.
class Body {
 public:
  Body(const std::uint8_t* bytes, std::size_t size, bool little_endian)
      : bytes_(bytes), size_(size), little_(little_endian) {}

  std::size_t size() const { return size_; }
  const std::uint8_t* at(std::size_t place) const { return bytes_ + place; }

  std::uint16_t half(std::size_t place) const {
    const unsigned first = bytes_[place], second = bytes_[place + 1];
    return static_cast<std::uint16_t>(little_ ? first | second << 8U : first << 8U | second);
  }
  std::uint32_t word(std::size_t place) const {
    const std::uint32_t first = half(place), second = half(place + 2);
    return little_ ? first | second << 16U : first << 16U | second;
  }
  /// The upper half comes first, in either byte order.
  std::uint64_t sequence_number(std::size_t place) const {
    return std::uint64_t{word(place)} << 32U | word(place + 4);
  }
  Body from(std::size_t place) const { return {bytes_ + place, size_ - place, little_}; }

 private:
  const std::uint8_t* bytes_;
  std::size_t size_;
  bool little_;
};

/// Bytes of a parameter list, sentinel included; 0 where it leaves the body.
std::size_t parameter_list(const Body& body) {
  std::size_t place = 0;
  while (place + 4 <= body.size()) {
    const std::uint16_t id = body.half(place);
    if (id == kSentinel) return place + 4;
    place += 4 + ((std::size_t{body.half(place + 2)} + 3U) & ~std::size_t{3});
  }
  return 0;
}

/// Bytes of a set whose numbers take `number` bytes; 0 where it leaves the body. The set begins at
/// `place`, which is inside.
std::size_t set_size(const Body& body, std::size_t place, std::size_t number) {
  const std::uint32_t bits = body.word(place + number);
  const std::size_t size = number + 4 + 4 * ((std::size_t{bits} + 31) / 32);
  return bits <= kMostBits && place + size <= body.size() ? size : 0;
}

bool is_sequence_number(std::uint64_t number) {
  return number > 0 && number < kLastSequenceNumber;
}

/// What DATA and DATA_FRAG have in common: where the payload begins; 0 where that is nowhere.
std::size_t payload_of(const Body& body, std::uint8_t flags, std::size_t smallest) {
  constexpr std::size_t kOffsetEnd = 4;
  std::size_t place = kOffsetEnd + body.half(2);
  if (place < smallest || place > body.size()) return 0;
  if ((flags & kInlineQos) != 0) {
    const std::size_t list = parameter_list(body.from(place));
    if (list == 0) return 0;
    place += list;
  }
  return place;
}

const char* check_data(const Body& body, std::uint8_t flags) {
  constexpr std::size_t kFixed = 20;
  if (body.size() < kFixed) return "a DATA that is cut";
  if (!is_sequence_number(body.sequence_number(12))) return "a DATA without a number";
  const std::size_t payload = payload_of(body, flags, kFixed);
  if (payload == 0) return "a DATA whose payload begins outside of it";
  const std::size_t size = body.size() - payload;
  if ((flags & (kHasData | kHasKey)) == 0) return nullptr;
  if (size < kEncapsulation) return "a DATA whose payload is cut";
  const std::uint8_t kind = body.at(8)[3];
  const std::uint8_t encapsulation = body.at(payload)[1];
  const bool is_list = encapsulation == kParameterListBig || encapsulation == kParameterListLittle;
  if ((kind & kBuiltin) != kBuiltin || !is_list) return nullptr;
  const Body list(body.at(payload + kEncapsulation), size - kEncapsulation,
                  encapsulation == kParameterListLittle);
  return parameter_list(list) == 0 ? "a list of parameters that does not end" : nullptr;
}

const char* check_fragment(const Body& body, std::uint8_t flags) {
  constexpr std::size_t kFixed = 32;
  if (body.size() < kFixed) return "a DATA_FRAG that is cut";
  if (!is_sequence_number(body.sequence_number(12))) return "a DATA_FRAG without a number";
  const std::uint64_t first = body.word(20), count = body.half(24);
  const std::uint64_t size = body.half(26), sample = body.word(28);
  if (first == 0 || count == 0 || size == 0) return "a DATA_FRAG without a fragment";
  if (count > RtpsGuard::kMostFragments) return "a DATA_FRAG of too many fragments";
  if (sample > kLargestSample) return "a DATA_FRAG of a sample that is too large";
  if ((first - 1 + count - 1) * size >= sample) return "a DATA_FRAG that is not in its sample";
  const std::size_t payload = payload_of(body, flags, kFixed);
  if (payload == 0) return "a DATA_FRAG whose payload begins outside of it";
  const std::uint64_t needed = std::min(count * size, sample - (first - 1) * size);
  return body.size() - payload < needed ? "a DATA_FRAG whose payload is cut" : nullptr;
}

const char* check_heartbeat(const Body& body) {
  if (body.size() < 28) return "a HEARTBEAT that is cut";
  const std::uint64_t first = body.sequence_number(8), last = body.sequence_number(16);
  const bool sound = is_sequence_number(first) && last < kLastSequenceNumber && last + 1 >= first;
  return sound ? nullptr : "a HEARTBEAT of no numbers";
}

const char* check_acknack(const Body& body) {
  constexpr std::size_t kSet = 8;
  if (body.size() < 24) return "an ACKNACK that is cut";
  const std::size_t size = set_size(body, kSet, 8);
  if (size == 0 || kSet + size + 4 > body.size()) return "an ACKNACK of a set that is cut";
  return body.sequence_number(kSet) < kLastSequenceNumber ? nullptr : "an ACKNACK of no numbers";
}

const char* check_gap(const Body& body) {
  constexpr std::size_t kSet = 16;
  if (body.size() < 28) return "a GAP that is cut";
  const std::uint64_t begin = body.sequence_number(8), end = body.sequence_number(kSet);
  if (set_size(body, kSet, 8) == 0) return "a GAP of a set that is cut";
  if (!is_sequence_number(begin) || !is_sequence_number(end)) return "a GAP of no numbers";
  return end > begin && end - begin > kLongestGap ? "a GAP that is too long" : nullptr;
}

const char* check_nack_fragments(const Body& body) {
  constexpr std::size_t kSet = 16;
  if (body.size() < 28) return "a NACK_FRAG that is cut";
  const std::size_t size = set_size(body, kSet, 4);
  if (size == 0 || kSet + size + 4 > body.size()) return "a NACK_FRAG of a set that is cut";
  const bool sound = is_sequence_number(body.sequence_number(8)) && body.word(kSet) > 0 &&
                     body.word(kSet) <= kLargestSample;
  return sound ? nullptr : "a NACK_FRAG of no numbers";
}

const char* check(std::uint8_t id, std::uint8_t flags, const Body& body) {
  switch (id) {
    case kData:
      return check_data(body, flags);
    case kDataFragment:
      return check_fragment(body, flags);
    case kHeartbeat:
      return check_heartbeat(body);
    case kAckNack:
      return check_acknack(body);
    case kGap:
      return check_gap(body);
    case kNackFragments:
      return check_nack_fragments(body);
    case kHeartbeatFragment:
      return body.size() < 24 ? "a HEARTBEAT_FRAG that is cut" : nullptr;
    case kInfoTimestamp:
      return (flags & kInvalidate) == 0 && body.size() < 8 ? "an INFO_TS that is cut" : nullptr;
    case kInfoSource:
      return body.size() < 20 ? "an INFO_SRC that is cut" : nullptr;
    case kInfoDestination:
      return body.size() < 12 ? "an INFO_DST that is cut" : nullptr;
    default:
      return nullptr;
  }
}

/// What a submessage, which is sound, says of its writer's numbers.
struct Claim {
  const std::uint8_t* writer = nullptr;  ///< entity; null: nothing is said
  std::uint64_t number = 0;              ///< that the writer has got to
  std::uint32_t size = 0;                ///< of the sample with that number; 0: nothing is said
};

Claim claim_of(std::uint8_t id, const Body& body) {
  switch (id) {
    case kData:
      return {body.at(8), body.sequence_number(12), 0};
    case kDataFragment:
      return {body.at(8), body.sequence_number(12), body.word(28)};
    case kHeartbeat:
      return {body.at(4), body.sequence_number(16), 0};
    case kGap:
      return {body.at(4), body.sequence_number(16), 0};
    default:
      return {};
  }
}

}  // namespace

RtpsGuard::Verdict RtpsGuard::judge(const std::uint8_t* datagram, std::size_t size) {
  Verdict verdict;
  if (size < kHeader || std::memcmp(datagram, "RTPS", 4) != 0) return {"no RTPS message"};
  const auto cut_at = [&verdict](std::size_t sound) {
    if (sound == kHeader) return Verdict{"a submessage that is cut"};
    verdict.size = sound;
    return verdict;
  };
  const bool from_eprosima = datagram[6] == 0x01 && datagram[7] == 0x0f;
  WriterGuid writer;
  std::copy_n(datagram + 8, kPrefix, writer.begin());
  for (std::size_t place = kHeader; place < size;) {
    const std::size_t begin = place;
    if (size - place < kSubmessageHeader) return cut_at(begin);
    const std::uint8_t id = datagram[place], flags = datagram[place + 1];
    const bool little_endian = (flags & kLittleEndian) != 0;
    const std::size_t length = Body(datagram + place, size - place, little_endian).half(2);
    place += kSubmessageHeader;
    // Zero: to the end of the datagram, but for those that may be empty (9.4.5.1.3).
    const bool is_last = length == 0 && id != kInfoTimestamp && id != kPad;
    const Body body(datagram + place, is_last ? size - place : length, little_endian);
    if (body.size() > size - place) return cut_at(begin);
    if (const char* problem = check(id, flags, body)) return {problem};
    if (id == kStatistics && from_eprosima && body.size() != size - place) {
      return {"statistics that are not at the end"};
    }
    if (id == kInfoSource) std::copy_n(body.at(8), kPrefix, writer.begin());
    if (const Claim claim = claim_of(id, body); claim.writer != nullptr) {
      std::copy_n(claim.writer, writer.size() - kPrefix, writer.begin() + kPrefix);
      if (!numbers_.accept(writer, claim.number)) return {"a sequence number that is far ahead"};
      if (!sizes_.accept(writer, claim.number, claim.size)) {
        return {"a DATA_FRAG of a sample that is larger than any before"};
      }
    }
    verdict.has_fragments = verdict.has_fragments || id == kDataFragment;
    if (is_last) break;
    place += (body.size() + 3) & ~std::size_t{3};
  }
  verdict.size = size;
  return verdict;
}

}  // namespace swiftlet
