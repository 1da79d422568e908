// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/supervision/parameter_server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace swiftlet {
namespace {

using namespace swiftlet_msgs::msg::ParameterRequest_Constants;
using namespace swiftlet_msgs::msg::Parameter_Constants;
using ::testing::HasSubstr;

struct Params {
  double gain = 2.0;
  double mass = 0.5;
  Eigen::Vector3d offset{1.0, 2.0, 3.0};
  std::string name = "a b";
};

Params read_params(const Config& config) {
  Params params;
  config.read("gain", params.gain, {0.1, 10.0});
  config.child("model").read("mass", params.mass, kPositive);
  config.read("offset", params.offset);
  config.read("name", params.name);
  if (params.gain == 7.0) throw std::invalid_argument("seven is out of luck");
  return params;
}

struct Server {
  Config config = Config::parse("{model: {mass: 0.8}}", "test.yaml");
  Params params = read_params(config);
  ParameterServer server{config};
  bool flies = false;
  int requests = 0;

  Server() {
    server.allow({{"gain", "offset"},
                  {"name"},
                  [this] { return flies; },
                  [this](const Config& changed) { params = read_params(changed); }});
  }
  swiftlet_msgs::msg::ParameterReply ask(std::uint8_t command, const std::string& name = "",
                                         const std::string& value = "") {
    swiftlet_msgs::msg::ParameterRequest request;
    request.id(std::to_string(++requests));
    request.command(command);
    request.name(name);
    request.value(value);
    return server.answer(request);
  }
};

TEST(ParameterServer, ListsAllThatIsReadWithTypesLimitsAndPresentValues) {
  Server server;
  const auto reply = server.ask(LIST);
  ASSERT_TRUE(reply.accepted());
  ASSERT_EQ(reply.parameters().size(), 4u);
  const auto& gain = reply.parameters()[0];
  EXPECT_EQ(gain.name(), "gain");
  EXPECT_EQ(gain.type(), "double");
  EXPECT_EQ(gain.value(), "2");
  EXPECT_EQ(gain.limits(), "from 0.1 to 10");
  EXPECT_EQ(gain.changes(), AT_ANY_TIME);
  const auto& mass = reply.parameters()[1];
  EXPECT_EQ(mass.name(), "model.mass");
  EXPECT_EQ(mass.value(), "0.8") << "from the file";
  EXPECT_EQ(mass.changes(), AT_START);
  EXPECT_EQ(reply.parameters()[2].value(), "[1, 2, 3]");
  EXPECT_EQ(reply.parameters()[3].value(), "a b");
}

TEST(ParameterServer, WhatItListsCanBeReadAgain) {
  Server server;
  std::string yaml;
  const auto reply = server.ask(LIST);
  for (const auto& parameter : reply.parameters()) {
    if (parameter.name().find('.') == std::string::npos) {
      yaml += parameter.name() + ": " + parameter.value() + "\n";
    }
  }
  const Params again = read_params(Config::parse(yaml, "dump"));
  EXPECT_EQ(again.offset, server.params.offset);
  EXPECT_EQ(again.name, server.params.name);
}

TEST(ParameterServer, ALiveParameterChangesAtOnce) {
  Server server;
  const auto reply = server.ask(SET, "gain", "3.5");
  ASSERT_TRUE(reply.accepted()) << reply.reason();
  EXPECT_EQ(server.params.gain, 3.5);
  EXPECT_EQ(server.params.mass, 0.8) << "the rest stays";
  EXPECT_EQ(reply.parameters().at(0).value(), "3.5");
  EXPECT_EQ(server.ask(GET, "gain").parameters().at(0).value(), "3.5");
  ASSERT_TRUE(server.ask(SET, "offset", "[4, 5, 6]").accepted());
  EXPECT_EQ(server.params.gain, 3.5) << "an earlier change stays, too";
  EXPECT_EQ(server.params.offset, Eigen::Vector3d(4, 5, 6));
}

TEST(ParameterServer, WhatCannotBeUsedIsRefusedAndChangesNothing) {
  Server server;
  const auto refusal = [&](const char* name, const char* value) {
    const auto reply = server.ask(SET, name, value);
    EXPECT_FALSE(reply.accepted()) << name << "=" << value;
    EXPECT_TRUE(reply.parameters().empty());
    return reply.reason();
  };
  EXPECT_THAT(refusal("gain", "30"), HasSubstr("from 0.1 to 10"));
  EXPECT_THAT(refusal("gain", ".nan"), HasSubstr("finite"));
  EXPECT_THAT(refusal("gain", "fast"), HasSubstr("must be a number"));
  EXPECT_THAT(refusal("gain", "7"), HasSubstr("out of luck"));
  EXPECT_THAT(refusal("gain", "{"), HasSubstr("not valid YAML"));
  EXPECT_THAT(refusal("offset", "[1, 2]"), HasSubstr("3 numbers"));
  EXPECT_THAT(refusal("model.mass", "1"), HasSubstr("start the component again"));
  EXPECT_THAT(refusal("gian", "1"), HasSubstr("did you mean 'gain'?"));
  EXPECT_EQ(server.params.gain, 2.0);
  EXPECT_EQ(server.ask(GET, "gain").parameters().at(0).value(), "2");
}

TEST(ParameterServer, WhatChangesOnTheGroundDoesNotInFlight) {
  Server server;
  EXPECT_EQ(server.ask(GET, "name").parameters().at(0).changes(), ON_GROUND);
  EXPECT_TRUE(server.ask(SET, "name", "before").accepted());
  server.flies = true;
  const auto refused = server.ask(SET, "name", "after");
  EXPECT_FALSE(refused.accepted());
  EXPECT_THAT(refused.reason(), HasSubstr("before lift-off"));
  EXPECT_EQ(server.params.name, "before");
  EXPECT_TRUE(server.ask(SET, "gain", "3").accepted()) << "this one may change in flight";
}

TEST(ParameterServer, ASectionOfAFileChangesAsTheWholeOfOne) {
  const Config file = Config::parse("{planner: {speed: 1}, estimator: {speed: 7}}", "test.yaml");
  const Config section = file.child("planner");
  double speed = 0.0;
  const auto read = [&speed](const Config& config) { config.read("speed", speed); };
  read(section);
  ParameterServer server(section);
  server.allow({{"speed"}, {}, nullptr, read});
  swiftlet_msgs::msg::ParameterRequest request;
  request.command(SET);
  request.name("speed");
  request.value("2");
  const auto reply = server.answer(request);
  ASSERT_TRUE(reply.accepted()) << reply.reason();
  EXPECT_EQ(speed, 2.0);
  EXPECT_EQ(reply.parameters().at(0).value(), "2");
}

TEST(ParameterServer, ANameThatNobodyReadsIsAMistake) {
  Server server;
  EXPECT_THROW(server.server.allow({{"gian"}, {}, nullptr, nullptr}), std::invalid_argument);
  EXPECT_THROW(server.server.allow({{}, {"mass"}, nullptr, nullptr}), std::invalid_argument);
}

TEST(ParameterServer, TheSameRequestTwiceIsCarriedOutOnce) {
  Server server;
  swiftlet_msgs::msg::ParameterRequest request;
  request.id("x");
  request.command(SET);
  request.name("gain");
  request.value("5");
  EXPECT_TRUE(server.server.answer(request).accepted());
  server.ask(SET, "gain", "6");
  EXPECT_TRUE(server.server.answer(request).accepted());
  EXPECT_EQ(server.params.gain, 6.0) << "answered again, not set again";
}

}  // namespace
}  // namespace swiftlet
