// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/plain_types.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <random>

#include "all_messages.hpp"

namespace swiftlet {
namespace {

/// The generated serialiser is the oracle: memory full of random bytes must be its own CDR.
template <class T>
void expect_memory_is_cdr(std::mt19937& random) {
  const MessageType& type = message_type<T>();
  auto object = std::make_unique<T>();
  auto* bytes = reinterpret_cast<std::uint8_t*>(object.get());
  std::uniform_int_distribution<int> any(0, 255);
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes[i] = static_cast<std::uint8_t>(any(random));
  const Cdr cdr = to_cdr(*object);
  ASSERT_EQ(cdr.size(), 4 + type.plain_size()) << type.name();
  EXPECT_EQ(std::memcmp(cdr.data() + 4, bytes, sizeof(T)), 0) << type.name();
  // A loan begins behind the four bytes of encapsulation of a buffer that is aligned to eight.
  EXPECT_LE(alignof(T), 4u) << type.name();
}

TEST(PlainTypes, LieInMemoryAsInCdr) {
  std::mt19937 random(3);
  int checked = 0;
#define SWIFTLET_MESSAGE(package, Name)               \
  if constexpr (IsPlain<package::msg::Name>::value) { \
    expect_memory_is_cdr<package::msg::Name>(random); \
    ++checked;                                        \
  }
#include "all_messages.inc"
#undef SWIFTLET_MESSAGE
  EXPECT_EQ(checked, 5);
}

TEST(PlainTypes, AreTheFramesAndNoTypeWithStringsOrSequences) {
  for (const MessageType* type : message_types()) {
    const bool is_frame = type->name().rfind("swiftlet_frames/msg/", 0) == 0 &&
                          type->name().find("Info") == std::string::npos;
    EXPECT_EQ(type->plain_size() > 0, is_frame) << type->name();
  }
}

}  // namespace
}  // namespace swiftlet
