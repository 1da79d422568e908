// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/reflection/cdr_decoder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace swiftlet {
namespace {

using Kind = TypeDescription::Kind;

constexpr std::size_t kEncapsulation = 4;
constexpr std::size_t kPadding = 3;
constexpr int kMaxDepth = 64;  // of sequences that contain their own type

bool is_little_endian_machine() {
  const std::uint16_t one = 1;
  std::uint8_t first = 0;
  std::memcpy(&first, &one, 1);
  return first == 1;
}

/// Reads one message. Functions return false once something was wrong; `error` says what.
class Decoder {
 public:
  Decoder(const Cdr& cdr, bool little_endian)
      : bytes_(cdr.data() + kEncapsulation),
        size_(cdr.size() - kEncapsulation),
        swap_(little_endian != is_little_endian_machine()) {}

  bool read(const TypeDescription& type, Value& value, int depth) {
    value.type = &type;
    switch (type.kind) {
      case Kind::kPrimitive:
        return read_primitive(type, value);
      case Kind::kString:
        return read_string(type, value);
      case Kind::kArray:
        return read_elements(type, type.count, value, depth);
      case Kind::kSequence: {
        std::uint32_t length = 0;
        if (!read_length(length)) return false;
        if (type.count != 0 && length > type.count) {
          return fail(fmt::format("{} elements in a {}", length, type.name));
        }
        return read_elements(type, length, value, depth);
      }
      case Kind::kStruct:
        return read_struct(type, value, depth);
    }
    return false;
  }

  std::size_t left() const { return size_ - at_; }
  /// "ranges: 7 bytes are missing"
  std::string error() const { return path_.empty() ? problem_ : path_ + ": " + problem_; }

 private:
  bool fail(const std::string& problem) {
    problem_ = problem;
    return false;
  }

  /// Called on the way out of an error, from the inside outwards.
  bool below(const std::string& step) {
    const bool separate = !path_.empty() && path_[0] != '[';
    path_ = step + (separate ? "." : "") + path_;
    return false;
  }

  bool align(std::size_t alignment) {
    const std::size_t padding = (alignment - at_ % alignment) % alignment;
    if (padding > left()) return fail("the message ends here");
    at_ += padding;
    return true;
  }

  /// Moves behind `count` primitives and returns where they begin; null where they are not there.
  const std::uint8_t* claim(Primitive primitive, std::size_t count) {
    const std::size_t size = size_of(primitive);
    if (!align(size)) return nullptr;
    if (count > left() / size) {
      fail(fmt::format("{} elements of {} bytes do not fit into the {} that are left", count, size,
                       left()));
      return nullptr;
    }
    const std::uint8_t* begin = bytes_ + at_;
    at_ += count * size;
    return begin;
  }

  /// Into the order of this machine.
  void put_in_order(std::uint8_t* bytes, std::size_t count, std::size_t size) const {
    if (!swap_ || size == 1) return;
    for (std::size_t i = 0; i < count; ++i) std::reverse(bytes + i * size, bytes + (i + 1) * size);
  }

  bool check(Primitive primitive, const std::uint8_t* begin, std::size_t count) {
    if (primitive != Primitive::kBoolean) return true;
    const std::uint8_t* end = begin + count;
    const auto* odd = std::find_if(begin, end, [](std::uint8_t byte) { return byte > 1; });
    return odd == end || fail(fmt::format("{} is no truth value", *odd));
  }

  bool read_primitive(const TypeDescription& type, Value& value) {
    const std::uint8_t* begin = claim(type.primitive, 1);
    if (begin == nullptr || !check(type.primitive, begin, 1)) return false;
    std::array<std::uint8_t, 8> bytes{};
    std::copy_n(begin, size_of(type.primitive), bytes.begin());
    put_in_order(bytes.data(), 1, size_of(type.primitive));
    value = primitive_value(type, bytes.data());
    return true;
  }

  bool read_length(std::uint32_t& length) {
    const std::uint8_t* begin = claim(Primitive::kUint32, 1);
    if (begin == nullptr) return false;
    std::array<std::uint8_t, 4> bytes{};
    std::copy_n(begin, bytes.size(), bytes.begin());
    put_in_order(bytes.data(), 1, bytes.size());
    std::memcpy(&length, bytes.data(), sizeof(length));
    return true;
  }

  bool read_numbers(Primitive primitive, std::size_t count, Value::Numbers& numbers) {
    numbers.primitive = primitive;
    if (count == 0) return true;  // then there is no padding for alignment either
    const std::uint8_t* begin = claim(primitive, count);
    if (begin == nullptr || !check(primitive, begin, count)) return false;
    numbers.bytes.assign(begin, begin + count * size_of(primitive));
    put_in_order(numbers.bytes.data(), count, size_of(primitive));
    return true;
  }

  bool read_string(const TypeDescription& type, Value& value) {
    std::uint32_t length = 0;
    if (!read_length(length)) return false;
    if (length > left()) {
      return fail(
          fmt::format("a text of {} bytes does not fit into the {} that are left", length, left()));
    }
    const auto* begin = reinterpret_cast<const char*>(bytes_ + at_);
    at_ += length;
    // The length counts the zero at the end; some writers leave both out.
    std::string text(begin, length);
    if (!text.empty() && text.back() == '\0') text.pop_back();
    if (type.count != 0 && text.size() > type.count) {
      return fail(fmt::format("{} characters in a {}", text.size(), type.name));
    }
    value.content = std::move(text);
    return true;
  }

  bool read_elements(const TypeDescription& type, std::uint32_t count, Value& value, int depth) {
    const TypeDescription& element = *type.element;
    if (element.kind == Kind::kPrimitive) {
      Value::Numbers numbers;
      if (!read_numbers(element.primitive, count, numbers)) return false;
      value.content = std::move(numbers);
      return true;
    }
    if (depth > kMaxDepth) return fail("more sequences in each other than anybody means");
    if (count > left() / element.minimum_size) {
      return fail(
          fmt::format("{} elements of at least {} bytes do not fit into the {} that are left",
                      count, element.minimum_size, left()));
    }
    Value::Parts parts(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!read(element, parts[i], depth + 1)) return below(fmt::format("[{}]", i));
    }
    value.content = std::move(parts);
    return true;
  }

  bool read_struct(const TypeDescription& type, Value& value, int depth) {
    Value::Parts parts(type.members.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const StructMember& member = type.members[i];
      if (!read(*member.type, parts[i], depth + 1)) return below(member.name);
    }
    value.content = std::move(parts);
    return true;
  }

  const std::uint8_t* bytes_;  // alignment counts from here
  std::size_t size_;
  bool swap_;
  std::size_t at_ = 0;
  std::string problem_;
  std::string path_;
};

}  // namespace

Result<Value> decode(const TypeDescription& type, const Cdr& cdr) {
  if (cdr.size() < kEncapsulation) {
    return Error{fmt::format("{} bytes are too few for any message", cdr.size())};
  }
  if (cdr[0] != 0 || cdr[1] > 1) {
    return Error{fmt::format("the encapsulation {:02x} {:02x} is not plain CDR (00 00 or 00 01)",
                             cdr[0], cdr[1])};
  }
  Decoder decoder(cdr, cdr[1] == 1);
  Value value;
  if (!decoder.read(type, value, 0)) {
    return Error{fmt::format("not a {}: {}", type.name, decoder.error())};
  }
  if (decoder.left() > kPadding) {
    return Error{
        fmt::format("{} bytes follow behind the {}: its writer has another definition of the type",
                    decoder.left(), type.name)};
  }
  return value;
}

}  // namespace swiftlet
