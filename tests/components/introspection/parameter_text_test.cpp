// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/parameter_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "components/runtime/config/config.hpp"

namespace swiftlet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

swiftlet_msgs::msg::Parameter parameter(const std::string& name, const std::string& value) {
  swiftlet_msgs::msg::Parameter result;
  result.name(name);
  result.type("double");
  result.value(value);
  result.limits("positive");
  return result;
}

swiftlet_msgs::msg::ParameterReply reply(
    const std::string& component, const std::string& process,
    const std::vector<swiftlet_msgs::msg::Parameter>& parameters) {
  swiftlet_msgs::msg::ParameterReply result;
  result.component_name(component);
  result.process(process);
  result.accepted(true);
  result.parameters(parameters);
  return result;
}

TEST(ParameterYaml, IsAFileThatGivesTheSameValues) {
  std::vector<std::string> differing;
  const std::string yaml = parameters_yaml(
      {reply("planner", "p",
             {parameter("max_speed", "1.5"), parameter("model.mass", "0.9"),
              parameter("name", "\"a: b\\n\""), parameter("model.gains.rate", "[1, 2, 3]"),
              parameter("odd", "line\nbreak")}),
       reply("empty", "p", {})},
      differing);
  const Config config = Config::parse(yaml, "dump.yaml");
  EXPECT_THAT(config.keys(), ElementsAre("planner", "empty"));
  const Config planner = config.child("planner");
  double speed = 0.0;
  double mass = 0.0;
  std::string name;
  std::string odd;
  std::vector<double> rate;
  planner.read("max_speed", speed);
  planner.child("model").read("mass", mass);
  planner.child("model").child("gains").read("rate", rate);
  planner.read("name", name);
  planner.read("odd", odd);
  (void)config.child("empty");
  EXPECT_NO_THROW(config.finish()) << "nothing else is in it";
  EXPECT_EQ(speed, 1.5);
  EXPECT_EQ(mass, 0.9);
  EXPECT_EQ(name, "a: b\n");
  EXPECT_EQ(odd, "line\nbreak");
  EXPECT_THAT(rate, ElementsAre(1, 2, 3));
  EXPECT_THAT(differing, IsEmpty());
}

TEST(ParameterYaml, InstancesThatDifferAreNamed) {
  std::vector<std::string> differing;
  const auto a = reply("planner", "a", {parameter("x", "1")});
  const auto b = reply("planner", "b", {parameter("x", "1")});
  EXPECT_EQ(parameters_yaml({a, b}, differing), "planner:\n  x: 1\n");
  EXPECT_THAT(differing, IsEmpty());
  (void)parameters_yaml({a, reply("planner", "b", {parameter("x", "2")})}, differing);
  EXPECT_THAT(differing, ElementsAre("planner"));
}

TEST(ParameterText, SaysTypeLimitsAndWhenItMayBeSet) {
  using namespace swiftlet_msgs::msg::Parameter_Constants;
  auto always = parameter("x", "1");
  always.changes(AT_ANY_TIME);
  auto before = parameter("z", "3");
  before.changes(ON_GROUND);
  const auto replies = {reply("planner", "planner.1", {always, parameter("y", "2"), before})};
  const std::string text = parameters_text(replies);
  EXPECT_THAT(text, HasSubstr("planner (planner.1):\n  x "));
  EXPECT_THAT(text, HasSubstr("double, positive, at any time\n  y "));
  EXPECT_THAT(text, HasSubstr("double, positive\n  z ")) << "most are read at the start";
  EXPECT_THAT(text, HasSubstr("double, positive, on ground\n"));
  EXPECT_EQ(parameters_json(replies)[0]["parameters"][0]["changes"], "at any time");
  EXPECT_EQ(parameters_json(replies)[0]["parameters"][1]["changes"], "at start");
}

}  // namespace
}  // namespace swiftlet
