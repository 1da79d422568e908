// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Random objects of the generated classes, and what their decoded values must be.
#pragma once

#include <fastcdr/Cdr.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "all_messages.hpp"
#include "components/runtime/message.hpp"
#include "components/runtime/reflection/value.hpp"

namespace swiftlet::test {

// Of a dependent name, so that the visitors of all structs are found wherever they stand.
#include "visit_members.inc"

/// Fills any member with values that include the ends of its range, NaN and infinity.
class Randomizer {
 public:
  explicit Randomizer(unsigned seed) : random_(seed) {}

  template <class T>
  void operator()(const char*, T& member) {
    fill(member);
  }

  template <class T>
  void fill(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      value = pick(2) == 0;
    } else if constexpr (std::is_integral_v<T>) {
      const std::array<T, 4> special{0, 1, std::numeric_limits<T>::min(),
                                     std::numeric_limits<T>::max()};
      const unsigned choice = pick(8);
      value = choice < 4 ? special[choice] : static_cast<T>(random_());
    } else if constexpr (std::is_floating_point_v<T>) {
      const std::array<T, 5> special{T(0), -T(0), std::numeric_limits<T>::quiet_NaN(),
                                     -std::numeric_limits<T>::infinity(),
                                     std::numeric_limits<T>::denorm_min()};
      const unsigned choice = pick(10);
      value = choice < 5 ? special[choice]
                         : static_cast<T>(std::normal_distribution<double>(0.0, 100.0)(random_));
    } else {
      visit_members(value, *this);
    }
  }

  void fill(std::string& text) {
    text.resize(pick(12));
    // No zeros: the generated classes end a text at the first.
    for (char& c : text) c = static_cast<char>(1 + pick(255));
  }

  template <class T>
  void fill(std::vector<T>& list) {
    list.resize(pick(5));
    for (T& element : list) fill(element);
  }

  template <class T, std::size_t N>
  void fill(std::array<T, N>& list) {
    for (T& element : list) fill(element);
  }

 private:
  unsigned pick(unsigned count) { return static_cast<unsigned>(random_() % count); }

  std::mt19937 random_;
};

/// Whether a decoded value is the object, member by member, bit by bit.
class Comparison {
 public:
  explicit Comparison(const Value& value) : value_(value) {}

  template <class T>
  void operator()(const char* name, T& member) {
    ASSERT_LT(next_, value_.size()) << name;
    EXPECT_EQ(value_.type->members[next_].name, name);
    check(value_.at(next_), member);
    ++next_;
  }

  template <class T>
  static void check(const Value& value, T& expected) {
    if constexpr (std::is_same_v<T, bool>) {
      EXPECT_EQ(std::get<bool>(value.content), expected);
    } else if constexpr (std::is_integral_v<T>) {
      using Wide = std::conditional_t<std::is_signed_v<T>, std::int64_t, std::uint64_t>;
      EXPECT_EQ(std::get<Wide>(value.content), Wide(expected));
    } else if constexpr (std::is_floating_point_v<T>) {
      EXPECT_EQ(std::memcmp(&std::get<T>(value.content), &expected, sizeof(T)), 0) << expected;
    } else {
      Comparison members(value);
      visit_members(expected, members);
      EXPECT_EQ(members.next_, value.size());
    }
  }

  static void check(const Value& value, std::string& expected) {
    EXPECT_EQ(std::get<std::string>(value.content), expected);
  }

  template <class T>
  static void check(const Value& value, std::vector<T>& expected) {
    check_list(value, expected);
  }
  template <class T, std::size_t N>
  static void check(const Value& value, std::array<T, N>& expected) {
    check_list(value, expected);
  }

 private:
  template <class List>
  static void check_list(const Value& value, List& expected) {
    ASSERT_EQ(value.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) check(value.at(i), expected[i]);
  }

  const Value& value_;
  std::size_t next_ = 0;
};

template <class T>
T random_message(unsigned seed) {
  T message;
  Randomizer(seed).fill(message);
  return message;
}

/// The same in the other byte order.
template <class T>
Cdr big_endian(const T& message) {
  using Stream = eprosima::fastcdr::Cdr;
  std::vector<char> bytes(4 + T::getCdrSerializedSize(message));
  eprosima::fastcdr::FastBuffer buffer(bytes.data(), bytes.size());
  Stream stream(buffer, Stream::BIG_ENDIANNESS, Stream::DDS_CDR);
  stream.serialize_encapsulation();
  message.serialize(stream);
  return {bytes.begin(), bytes.begin() + static_cast<long>(stream.getSerializedDataLength())};
}

}  // namespace swiftlet::test
