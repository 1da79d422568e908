// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Decoding by description, against the classes that fastddsgen makes of the same IDL.
#include "components/runtime/reflection/cdr_decoder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "components/runtime/reflection/value_text.hpp"
#include "tests/components/runtime/reflection/random_message.hpp"

namespace swiftlet {
namespace {

using testing::AllOf;
using testing::HasSubstr;

template <class T>
struct EveryType : testing::Test {
  const TypeDescription& type = *TypeLibrary::built_in().find(message_type<T>().name());
};

template <class... T>
testing::Types<T...> without_first(testing::Types<void, T...>);
using Messages = decltype(without_first(testing::Types<void
#define SWIFTLET_MESSAGE(package, Name) , package::msg::Name
#include "all_messages.inc"
#undef SWIFTLET_MESSAGE
                                                       >()));

struct TypeName {
  template <class T>
  static std::string GetName(int) {
    std::string name = message_type<T>().name();
    std::replace(name.begin(), name.end(), '/', '_');
    return name;
  }
};
TYPED_TEST_SUITE(EveryType, Messages, TypeName);

TYPED_TEST(EveryType, HasTheValuesOfTheGeneratedClassInBothByteOrders) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    TypeParam message = test::random_message<TypeParam>(seed);
    for (const Cdr& cdr : {to_cdr(message), test::big_endian(message)}) {
      const Result<Value> value = decode(this->type, cdr);
      ASSERT_TRUE(value.ok()) << value.error().reason;
      test::Comparison::check(*value, message);
    }
  }
}

/// Frames, whose elements are all alike.
constexpr std::size_t kLarge = 50'000;
constexpr std::size_t kEnds = 10;

TYPED_TEST(EveryType, CutAnywhereItIsAnError) {
  const bool is_large = sizeof(TypeParam) > kLarge;
  for (unsigned seed = 0; seed < (is_large ? 1 : 5); ++seed) {
    const Cdr whole = to_cdr(test::random_message<TypeParam>(seed));
    // Of what is large, the ends byte by byte and some places between.
    const auto step = [&](std::size_t size) {
      const bool near_an_end = size < kEnds || size + kEnds > whole.size();
      return near_an_end || !is_large ? 1 : whole.size() / 20;
    };
    for (std::size_t size = 0; size < whole.size();
         size = std::min(size + step(size), std::max(size + 1, whole.size() - kEnds))) {
      const Cdr cut(whole.begin(), whole.begin() + static_cast<long>(size));
      EXPECT_FALSE(decode(this->type, cut).ok()) << size << " of " << whole.size();
    }
  }
}

TYPED_TEST(EveryType, ChangedBytesAreTakenOrRefusedAsTheGeneratedClassDoes) {
  std::mt19937 random(7);
  int taken = 0;
  for (unsigned seed = 0; seed < (sizeof(TypeParam) > kLarge ? 2 : 200); ++seed) {
    Cdr cdr = to_cdr(test::random_message<TypeParam>(seed % 20));
    for (int i = 0; i < 3; ++i) {
      // The upper halves of lengths stay: the generated class takes the memory that they ask for.
      const std::size_t at = 4 + random() % (cdr.size() - 4);
      if (at % 4 < 2) cdr[at] = static_cast<std::uint8_t>(random());
    }
    const auto expected = std::make_unique<TypeParam>();  // a frame fills a stack
    const bool readable =
        message_type<TypeParam>().deserialize(cdr.data(), cdr.size(), expected.get());
    const Result<Value> value = decode(this->type, cdr);
    if (value.ok()) {
      ++taken;
      ASSERT_TRUE(readable);
      test::Comparison::check(*value, *expected);
    } else if (value.error().reason.find("follow behind") == std::string::npos) {
      EXPECT_FALSE(readable) << value.error().reason;
    }
  }
  EXPECT_GT(taken, 0);
}

const TypeDescription& type_named(const std::string& name) {
  return *TypeLibrary::built_in().find(name);
}

TEST(CdrDecoder, AnyBytesAreSurvived) {
  std::mt19937 random(3);
  for (const TypeDescription* type : TypeLibrary::built_in().structs()) {
    for (int i = 0; i < 300; ++i) {
      Cdr cdr(random() % 200);
      for (auto& byte : cdr) byte = static_cast<std::uint8_t>(random() % 3 == 0 ? random() : 0);
      if (cdr.size() > 1) cdr[0] = 0, cdr[1] = random() % 2;
      const Result<Value> value = decode(*type, cdr);
      if (value.ok()) {
        EXPECT_FALSE(to_yaml(*value).empty());
      }
    }
  }
}

TEST(CdrDecoder, ALengthBeyondTheMessageIsRefusedAndTheFieldNamed) {
  sensor_msgs::msg::LaserScan scan;
  scan.ranges({1, 2, 3});
  Cdr cdr = to_cdr(scan);
  const std::size_t length = cdr.size() - 4 - 3 * 4 - 4;  // behind it three floats, no intensity
  ASSERT_EQ(cdr[length], 3);
  for (const int byte : {0x05, 0xFF}) {
    cdr[length] = cdr[length + 3] = static_cast<std::uint8_t>(byte);
    const auto value = decode(type_named("sensor_msgs/msg/LaserScan"), cdr);
    ASSERT_FALSE(value.ok());
    EXPECT_THAT(value.error().reason,
                AllOf(HasSubstr("sensor_msgs/msg/LaserScan: ranges:"), HasSubstr("do not fit")));
  }
  nav_msgs::msg::Path path;
  path.poses().resize(1);
  cdr = to_cdr(path);
  cdr.resize(cdr.size() - 20);
  EXPECT_THAT(decode(type_named("nav_msgs/msg/Path"), cdr).error().reason,
              HasSubstr("poses: 1 elements of at least"));
  path.poses().resize(2);
  cdr = to_cdr(path);
  cdr.resize(cdr.size() - 1);
  EXPECT_THAT(decode(type_named("nav_msgs/msg/Path"), cdr).error().reason,
              HasSubstr("poses[1].pose.orientation.w: "));
}

TEST(CdrDecoder, OtherEncapsulationsAndLeftoversAreNamed) {
  Cdr cdr = to_cdr(builtin_interfaces::msg::Time());
  const TypeDescription& time = type_named("builtin_interfaces/msg/Time");
  for (std::size_t padding = 1; padding <= 3; ++padding) {
    cdr.push_back(0);
    EXPECT_TRUE(decode(time, cdr).ok()) << padding << " bytes of padding";
  }
  cdr.push_back(0);
  EXPECT_THAT(decode(time, cdr).error().reason, HasSubstr("4 bytes follow"));
  cdr.resize(12);
  cdr[1] = 7;
  EXPECT_THAT(decode(time, cdr).error().reason, HasSubstr("00 07"));
}

TEST(CdrDecoder, TypesThatContainThemselvesAreReadToALimitedDepth) {
  const auto library =
      TypeLibrary::parse({{"a.idl", "module a { struct Tree { sequence<Tree> children; }; };"}});
  ASSERT_TRUE(library.ok()) << library.error().reason;
  const TypeDescription& tree = *library->find("a/Tree");
  const auto chain = [](int depth) {
    Cdr cdr{0, 1, 0, 0};
    for (int i = 0; i < depth; ++i) cdr.insert(cdr.end(), {1, 0, 0, 0});
    cdr.insert(cdr.end(), {0, 0, 0, 0});
    return cdr;
  };
  EXPECT_TRUE(decode(tree, chain(10)).ok());
  EXPECT_FALSE(decode(tree, chain(100'000)).ok());
}

}  // namespace
}  // namespace swiftlet
