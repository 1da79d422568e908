// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/reflection/idl_schema.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "components/runtime/message.hpp"

namespace swiftlet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// The sections of a schema: name, and the lines below it.
std::vector<std::pair<std::string, std::string>> sections(const std::string& schema) {
  std::vector<std::pair<std::string, std::string>> all;
  std::istringstream lines(schema);
  for (std::string line; std::getline(lines, line);) {
    if (line == std::string(80, '=')) {
      std::getline(lines, line);
      EXPECT_EQ(line.substr(0, 5), "IDL: ");
      all.emplace_back(line.substr(5), "");
    } else if (all.empty()) {
      ADD_FAILURE() << "text in front of the first section: " << line;
    } else {
      all.back().second += line + "\n";
    }
  }
  return all;
}

std::vector<std::string> names(const std::string& schema) {
  std::vector<std::string> all;
  for (const auto& [name, body] : sections(schema)) all.push_back(name);
  return all;
}

TEST(IdlSchema, HoldsTheTypeFirstAndAllThatItConsistsOf) {
  const auto schema = idl_schema("nav_msgs/msg/Odometry");
  ASSERT_TRUE(schema.ok()) << schema.error().reason;
  EXPECT_EQ(names(*schema).front(), "nav_msgs/msg/Odometry");
  EXPECT_THAT(names(*schema),
              testing::UnorderedElementsAre(
                  "nav_msgs/msg/Odometry", "std_msgs/msg/Header", "builtin_interfaces/msg/Time",
                  "geometry_msgs/msg/PoseWithCovariance", "geometry_msgs/msg/Pose",
                  "geometry_msgs/msg/Point", "geometry_msgs/msg/Quaternion",
                  "geometry_msgs/msg/TwistWithCovariance", "geometry_msgs/msg/Twist",
                  "geometry_msgs/msg/Vector3"));
}

TEST(IdlSchema, EveryMessageTypeHasOne) {
  ASSERT_FALSE(message_types().empty());
  for (const MessageType* type : message_types()) {
    const auto schema = idl_schema(type->name());
    ASSERT_TRUE(schema.ok()) << schema.error().reason;
    EXPECT_EQ(names(*schema).front(), type->name());
  }
}

TEST(IdlSchema, CommentsPragmasAndOtherTypesStayOut) {
  const std::string file =
      "#ifndef A\n#define A\n#include \"b.idl\"\n// struct Ghost { long x; };\n"
      "module a { module msg {\n"
      "module Thing_Constants { const uint8 RED = 1; };\n"
      "struct Thing { uint8 colour; /* Other other; */ Part part; sequence<a::msg::Leaf> leaves; "
      "};\n"
      "struct Part { Level level; double_9 covariance; };\n"
      "enum Level { LOW, HIGH };\n"
      "typedef double double_9[9];\n"
      "struct Leaf { string name; // of the Other\n };\n"
      "struct Other { long x; };\n"
      "}; };\n#endif\n";
  const auto schema = idl_schema("a/msg/Thing", {{"a.idl", file}});
  ASSERT_TRUE(schema.ok()) << schema.error().reason;
  EXPECT_THAT(names(*schema), ElementsAre("a/msg/Thing", "a/msg/Part", "a/msg/Level",
                                          "a/msg/double_9", "a/msg/Leaf"));
  EXPECT_THAT(*schema, HasSubstr("const uint8 RED = 1;"));
  EXPECT_EQ(schema->find("Ghost"), std::string::npos);
  EXPECT_EQ(schema->find("#"), std::string::npos);
  EXPECT_FALSE(idl_schema("a/msg/Ghost", {{"a.idl", file}}).ok());
}

TEST(IdlSchema, TypesThatContainEachOtherEnd) {
  const std::string file =
      "module a { module msg { struct A { sequence<a::msg::B> b; }; struct B { sequence<a::msg::A> "
      "a; }; }; };";
  EXPECT_THAT(names(*idl_schema("a/msg/A", {{"a.idl", file}})), ElementsAre("a/msg/A", "a/msg/B"));
}

TEST(IdlSchema, SaysWhatItDoesNotKnow) {
  const auto unknown = idl_schema("sensor_msgs/msg/Nose");
  ASSERT_FALSE(unknown.ok());
  EXPECT_THAT(unknown.error().reason, HasSubstr("sensor_msgs/msg/Nose"));
  for (const char* broken :
       {"module a { module msg { struct A { long x; ", "module a { struct A {};", "struct A {};",
        "module a { module msg { union U {}; }; };",
        "module a { module msg { module Other { const long X = 1; }; }; };"}) {
    EXPECT_FALSE(idl_schema("a/msg/A", {{"a.idl", broken}}).ok()) << broken;
  }
}

}  // namespace
}  // namespace swiftlet
