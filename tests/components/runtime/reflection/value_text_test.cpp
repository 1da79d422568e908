// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/reflection/value_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <nlohmann/json.hpp>

#include "components/runtime/reflection/cdr_decoder.hpp"
#include "tests/components/runtime/reflection/random_message.hpp"

namespace swiftlet {
namespace {

using testing::HasSubstr;

template <class T>
Value value_of(const T& message) {
  return decode(*TypeLibrary::built_in().find(message_type<T>().name()), to_cdr(message)).value();
}

sensor_msgs::msg::LaserScan small_scan() {
  sensor_msgs::msg::LaserScan scan;
  scan.header().stamp().sec(-3);
  scan.header().stamp().nanosec(4'000'000'000U);
  scan.header().frame_id("laser");
  scan.angle_min(-0.1F);
  scan.angle_increment(1e-5F);
  scan.range_max(30.0F);
  scan.ranges({1.5F, std::numeric_limits<float>::infinity(), -0.0F});
  return scan;
}

TEST(YamlText, IsThatOfRos2TopicEcho) {
  EXPECT_EQ(to_yaml(value_of(small_scan())),
            "header:\n"
            "  stamp:\n"
            "    sec: -3\n"
            "    nanosec: 4000000000\n"
            "  frame_id: laser\n"
            "angle_min: -0.1\n"
            "angle_max: 0.0\n"
            "angle_increment: 1.0e-05\n"
            "time_increment: 0.0\n"
            "scan_time: 0.0\n"
            "range_min: 0.0\n"
            "range_max: 30.0\n"
            "ranges:\n"
            "- 1.5\n"
            "- .inf\n"
            "- -0.0\n"
            "intensities: []\n");
}

TEST(YamlText, ListsOfStructsAreIndentedBelowTheirDash) {
  tf2_msgs::msg::TFMessage message;
  message.transforms().resize(2);
  message.transforms()[1].child_frame_id("base_link");
  const std::string text = to_yaml(value_of(message));
  EXPECT_THAT(text, testing::StartsWith("transforms:\n- header:\n    stamp:\n      sec: 0\n"));
  EXPECT_THAT(text, HasSubstr("\n  child_frame_id: base_link\n  transform:\n    translation:\n"));
}

TEST(YamlText, LongListsAndTextsAreCutUnlessAllIsWanted) {
  sensor_msgs::msg::LaserScan scan;
  scan.ranges().resize(129, 7.5F);
  scan.header().frame_id(std::string(127, 'x') + "\u00e9\u00e9");
  const Value value = value_of(scan);
  const std::string text = to_yaml(value);
  const YAML::Node cut = YAML::Load(text);
  EXPECT_EQ(cut["ranges"].size(), 129u);
  EXPECT_EQ(cut["ranges"][128].Scalar(), "...");
  EXPECT_EQ(cut["header"]["frame_id"].Scalar(), std::string(127, 'x') + "...");
  const YAML::Node whole = YAML::Load(to_yaml(value, {0, true}));
  EXPECT_EQ(whole["ranges"][128].as<float>(), 7.5F);
  EXPECT_EQ(whole["header"]["frame_id"].Scalar(), scan.header().frame_id());
  const YAML::Node none = YAML::Load(to_yaml(value, {128, false}));
  EXPECT_EQ(none["ranges"].Scalar(), "<sequence<float> of 129>");
  EXPECT_EQ(to_json(value, false)["ranges"], "sequence<float> of 129");
}

/// A YAML document must say the same as the JSON of the same value.
void expect_same(const YAML::Node& yaml, const nlohmann::ordered_json& json,
                 const std::string& path) {
  if (json.is_object()) {
    ASSERT_EQ(yaml.size(), json.size()) << path;
    for (const auto& [name, member] : json.items()) {
      expect_same(yaml[name], member, path + "." + name);
    }
  } else if (json.is_array()) {
    ASSERT_EQ(yaml.size(), json.size()) << path;
    for (std::size_t i = 0; i < json.size(); ++i) expect_same(yaml[i], json[i], path + "[]");
  } else if (json.is_boolean()) {
    EXPECT_EQ(yaml.as<bool>(), json.get<bool>()) << path;
  } else if (json.is_number_integer()) {
    EXPECT_EQ(yaml.Scalar(), json.dump()) << path;
  } else if (json.is_number()) {
    EXPECT_EQ(yaml.as<double>(), json.get<double>()) << path;
    EXPECT_THAT(yaml.Scalar(), HasSubstr(".")) << "a reader must see a floating-point number";
  } else if (const std::string text = json.get<std::string>(); text == "nan") {
    EXPECT_TRUE(std::isnan(yaml.as<double>())) << path;
  } else if (text == "inf" || text == "-inf") {
    EXPECT_EQ(yaml.Scalar(), text == "inf" ? ".inf" : "-.inf") << path;
  } else {
    EXPECT_EQ(yaml.Scalar(), text) << path;
  }
}

template <class T>
void expect_yaml_and_json_agree(unsigned seed) {
  // Frames are thousands of like elements: they show nothing that the small types do not.
  if constexpr (sizeof(T) > 50'000) return;
  const T message = test::random_message<T>(seed);
  const Value value = value_of(message);
  const auto json = to_json(value);
  using nlohmann::ordered_json;
  const std::string dumped = json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  expect_same(YAML::Load(to_yaml(value, {0, true})), ordered_json::parse(dumped), "");
}

TEST(YamlText, SaysTheSameAsTheJsonOfEveryType) {
  for (unsigned seed = 0; seed < 20; ++seed) {
#define SWIFTLET_MESSAGE(package, Name) expect_yaml_and_json_agree<package::msg::Name>(seed);
#include "all_messages.inc"
#undef SWIFTLET_MESSAGE
  }
}

TEST(YamlText, TextsThatLookLikeSomethingElseAreQuoted) {
  for (const char* text : {"", "true", "No", "null", "1", "1e3", "-", "a: b", "a #b", " a", "a ",
                           "[x]", "'", "\"", "line\nbreak", "~", ".nan", "\u00e9"}) {
    std_msgs::msg::Header header;
    header.frame_id(text);
    const std::string yaml = to_yaml(value_of(header));
    const YAML::Node node = YAML::Load(yaml)["frame_id"];
    EXPECT_EQ(node.Scalar(), text) << yaml;
    EXPECT_EQ(node.Tag(), "!") << "quoted, or it is read as no text: " << yaml;
  }
}

TEST(JsonText, KeepsTheOrderOfMembersAndHasTextsForWhatIsNoNumber) {
  auto scan = small_scan();
  scan.ranges(
      {0.1F, std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()});
  const std::string text = to_json(value_of(scan)).dump();
  EXPECT_THAT(text, testing::StartsWith(
                        R"({"header":{"stamp":{"sec":-3,"nanosec":4000000000},"frame_id":"laser"},)"
                        R"("angle_min":-0.1,)"));
  EXPECT_THAT(text, HasSubstr(R"("ranges":[0.1,"nan","-inf"])"));
}

}  // namespace
}  // namespace swiftlet
