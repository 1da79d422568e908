// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/reflection/first_difference.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/runtime/reflection/cdr_decoder.hpp"
#include "components/runtime/reflection/field_path.hpp"
#include "components/runtime/reflection/value_text.hpp"
#include "tests/components/runtime/reflection/random_message.hpp"

namespace swiftlet {
namespace {

using testing::HasSubstr;

template <class T>
const TypeDescription& type_of() {
  return *TypeLibrary::built_in().find(message_type<T>().name());
}

template <class T>
std::optional<Difference> difference(const T& a, const T& b) {
  return first_difference(type_of<T>(), to_cdr(a), to_cdr(b)).value();
}

TEST(FirstDifference, NamesTheFieldAndBothValues) {
  nav_msgs::msg::Odometry a;
  nav_msgs::msg::Odometry b;
  EXPECT_FALSE(difference(a, b));
  a.twist().covariance()[2] = 1.0;
  b.pose().pose().position().x(0.1);
  const auto found = difference(a, b);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->field, "pose.pose.position.x") << "which comes before twist";
  EXPECT_EQ(found->a, "0.0");
  EXPECT_EQ(found->b, "0.1");
  a.pose() = b.pose();
  EXPECT_EQ(difference(a, b)->field, "twist.covariance[2]");
}

TEST(FirstDifference, KnowsElementsLengthsTextsAndTheBitsOfNumbers) {
  sensor_msgs::msg::LaserScan a;
  a.ranges().resize(30, std::numeric_limits<float>::quiet_NaN());
  sensor_msgs::msg::LaserScan b = a;
  EXPECT_FALSE(difference(a, b)) << "NaN is the same as itself";
  b.ranges()[17] = 2.5F;
  EXPECT_EQ(difference(a, b)->field, "ranges[17]");
  b.ranges()[17] = -a.ranges()[17];
  EXPECT_NE(difference(a, b)->a, difference(a, b)->b) << "another NaN";
  b.ranges().resize(31);
  EXPECT_EQ(difference(a, b)->field, "ranges");
  EXPECT_EQ(difference(a, b)->b, "31 elements");
  b = a;
  b.angle_min(-0.0F);
  EXPECT_EQ(difference(a, b)->b, "-0.0");
  b.header().frame_id("laser");
  EXPECT_EQ(difference(a, b)->a, "''");
  tf2_msgs::msg::TFMessage c;
  c.transforms().resize(2);
  tf2_msgs::msg::TFMessage d = c;
  d.transforms()[1].child_frame_id("x");
  EXPECT_EQ(difference(c, d)->field, "transforms[1].child_frame_id");
}

TEST(FirstDifference, ByteOrderAndPaddingDoNotCount) {
  const auto message = test::random_message<diagnostic_msgs::msg::DiagnosticArray>(5);
  Cdr padded = to_cdr(message);
  padded.push_back(0x55);
  using Message = diagnostic_msgs::msg::DiagnosticArray;
  EXPECT_FALSE(*first_difference(type_of<Message>(), padded, test::big_endian(message)));
}

/// Two random messages differ, and the field that is named holds the two values that are named.
template <class T>
void expect_the_field_differs(unsigned seed) {
  // Frames are thousands of like elements: they show nothing that the small types do not.
  if constexpr (sizeof(T) > 50'000) return;
  const T a = test::random_message<T>(seed);
  const T b = test::random_message<T>(seed + 1000);
  const TypeDescription& type = type_of<T>();
  const auto found = difference(a, b);
  if (!found) {
    EXPECT_EQ(to_cdr(a), to_cdr(b));
    return;
  }
  const auto path = FieldPath::parse(type, found->field);
  ASSERT_TRUE(path.ok()) << path.error().reason;
  const Value value_a = *path->select(*decode(type, to_cdr(a)));
  const Value value_b = *path->select(*decode(type, to_cdr(b)));
  if (value_a.is_list()) {
    EXPECT_NE(value_a.size(), value_b.size());
  } else {
    EXPECT_THAT(found->a, testing::StartsWith(to_line(value_a)));
    EXPECT_THAT(found->b, testing::StartsWith(to_line(value_b)));
    EXPECT_NE(found->a, found->b);
  }
}

TEST(FirstDifference, HoldsForEveryType) {
  for (unsigned seed = 0; seed < 40; ++seed) {
#define SWIFTLET_MESSAGE(package, Name) expect_the_field_differs<package::msg::Name>(seed);
#include "all_messages.inc"
#undef SWIFTLET_MESSAGE
  }
}

TEST(FirstDifference, WhatIsNoMessageIsAnError) {
  const Cdr good = to_cdr(std_msgs::msg::Header());
  const TypeDescription& header = type_of<std_msgs::msg::Header>();
  EXPECT_FALSE(first_difference(header, good, {0, 1, 0, 0}).ok());
  EXPECT_FALSE(first_difference(header, {}, good).ok());
}

}  // namespace
}  // namespace swiftlet
