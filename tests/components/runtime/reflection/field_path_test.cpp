// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/reflection/field_path.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "all_messages.hpp"
#include "components/runtime/reflection/cdr_decoder.hpp"
#include "components/runtime/reflection/value_text.hpp"

namespace swiftlet {
namespace {

using testing::HasSubstr;

const TypeDescription& path_type() {
  return *TypeLibrary::built_in().find("nav_msgs/msg/Path");
}
const TypeDescription& odometry_type() {
  return *TypeLibrary::built_in().find("nav_msgs/msg/Odometry");
}

TEST(FieldPath, SelectsMembersAndElements) {
  nav_msgs::msg::Odometry odometry;
  odometry.pose().pose().position().x(2.5);
  odometry.pose().covariance()[35] = 7.0;
  const Value message = decode(odometry_type(), to_cdr(odometry)).value();
  const auto text = [&](const std::string& path) {
    return to_line(FieldPath::parse(odometry_type(), path)->select(message).value());
  };
  EXPECT_EQ(text("pose.pose.position.x"), "2.5");
  EXPECT_EQ(text("pose.covariance[35]"), "7.0");
  EXPECT_EQ(text("pose.covariance"), "double[36]");
  EXPECT_EQ(text("pose.pose"), "geometry_msgs/msg/Pose");
}

TEST(FieldPath, AnElementThatThisMessageLacksIsNamed) {
  nav_msgs::msg::Path path;
  path.poses().resize(2);
  path.poses()[1].pose().position().y(4.0);
  const Value message = decode(path_type(), to_cdr(path)).value();
  const std::string field = ".pose.position.y";
  EXPECT_EQ(to_line(*FieldPath::parse(path_type(), "poses[1]" + field)->select(message)), "4.0");
  const auto missing = FieldPath::parse(path_type(), "poses[2]" + field)->select(message);
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().reason, "there is no poses[2]: 2 elements");
}

TEST(FieldPath, WhatNoMessageCanHaveIsRefused) {
  const auto reason = [](const std::string& path) {
    const auto parsed = FieldPath::parse(odometry_type(), path);
    return parsed.ok() ? std::string("accepted") : parsed.error().reason;
  };
  EXPECT_THAT(reason("pose.pose.positon.x"), HasSubstr("did you mean 'position'?"));
  EXPECT_THAT(reason("zzzzzzzz"), HasSubstr("it has header, child_frame_id, pose, twist"));
  EXPECT_THAT(reason("pose.covariance[36]"), HasSubstr("has no element 36"));
  EXPECT_THAT(reason("pose.covariance[x]"), HasSubstr("'x' is no number"));
  EXPECT_THAT(reason("pose.covariance[3"), HasSubstr("']' is missing"));
  EXPECT_THAT(reason("pose[0]"), HasSubstr("has no elements"));
  EXPECT_THAT(reason("child_frame_id.x"), HasSubstr("no parts with names"));
  EXPECT_THAT(reason("pose."), HasSubstr("ends with '.'"));
  EXPECT_THAT(reason(".pose"), HasSubstr("has no ''"));
  EXPECT_THAT(reason("pose.covariance[1]x"), HasSubstr("'.' is missing"));
}

}  // namespace
}  // namespace swiftlet
