// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/config/config.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace swiftlet {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The message of the ConfigError that `action` throws, "" where it throws none.
template <class Action>
std::string error_of(Action action) {
  try {
    action();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Config, ReadsEachTypeAndKeepsDefaultsOfAbsentKeys) {
  const Config config = Config::parse(
      "flag: true\ncount: 3\nspeed: 1.5\nname: office\nlist: [1, 2.5]\nwords: [a, b]\n"
      "v: [1, 2, 3]\n",
      "f.yaml");
  bool flag = false;
  int count = 0;
  double speed = 0;
  double absent = 7;
  std::string name;
  std::vector<double> list;
  std::vector<std::string> words;
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  config.read("flag", flag);
  config.read("count", count);
  config.read("speed", speed);
  config.read("absent", absent);
  config.read("name", name);
  config.read("list", list);
  config.read("words", words);
  config.read("v", v);
  EXPECT_TRUE(flag);
  EXPECT_EQ(count, 3);
  EXPECT_EQ(speed, 1.5);
  EXPECT_EQ(absent, 7);
  EXPECT_EQ(name, "office");
  EXPECT_THAT(list, ElementsAre(1, 2.5));
  EXPECT_THAT(words, ElementsAre("a", "b"));
  EXPECT_EQ(v, Eigen::Vector3d(1, 2, 3));
  EXPECT_NO_THROW(config.finish());
}

TEST(Config, UnknownKeyNamesFileLineAndNearestKey) {
  const Config config = Config::parse("speed: 1\n\ngyro_nose: 2\n", "estimator.yaml");
  double value = 0;
  config.read("speed", value);
  config.read("gyro_noise", value);
  EXPECT_THAT(error_of([&] { config.finish(); }),
              AllOf(HasSubstr("estimator.yaml:3"), HasSubstr("unknown key 'gyro_nose'"),
                    HasSubstr("did you mean 'gyro_noise'?")));
}

TEST(Config, UnknownKeysAreFoundInNestedMappingsAndLists) {
  const Config config =
      Config::parse("a:\n  b: 1\n  c: 2\nitems:\n  - x: 1\n  - x: 1\n    z: 2\n", "f.yaml");
  double value = 0;
  config.child("a").read("b", value);
  config.child("a").read("c", value);
  for (const Config& item : config.list("items")) item.read("x", value);
  EXPECT_THAT(error_of([&] { config.finish(); }),
              AllOf(HasSubstr("f.yaml:7"), HasSubstr("items[1]"), HasSubstr("'z'")));
}

TEST(Config, FinishOfAChildChecksTheWholeFile) {
  const Config child = Config::parse("a: {b: 1}\nother: 2\n", "f.yaml").child("a");
  double value = 0;
  child.read("b", value);
  EXPECT_THAT(error_of([&] { child.finish(); }), HasSubstr("'other'"));
}

TEST(Config, EachKindOfBadValueNamesLineAndProblem) {
  const Config config = Config::parse(
      "text: fast\nnan: .nan\ninf: .inf\nlow: -1\nhalf: 1.5\npair: [1, 2]\nbad: [1, x]\nmap: {a: "
      "1}\n"
      "flag: 3\n",
      "f.yaml");
  double number = 4.0;
  int whole = 4;
  bool flag = false;
  Eigen::Vector3d v(1, 1, 1);
  std::vector<double> list;
  EXPECT_THAT(error_of([&] { config.read("text", number); }),
              AllOf(HasSubstr("f.yaml:1"), HasSubstr("must be a number, not 'fast'")));
  EXPECT_THAT(error_of([&] { config.read("nan", number); }),
              AllOf(HasSubstr("f.yaml:2"), HasSubstr("finite")));
  EXPECT_THAT(error_of([&] { config.read("inf", number); }), HasSubstr("finite"));
  EXPECT_THAT(error_of([&] { config.read("low", number, kNotNegative); }),
              AllOf(HasSubstr("f.yaml:4"), HasSubstr("at least 0"), HasSubstr("-1")));
  EXPECT_THAT(error_of([&] { config.read("low", number, kPositive); }), HasSubstr("positive"));
  EXPECT_THAT(error_of([&] { config.read("half", whole); }), HasSubstr("whole number"));
  EXPECT_THAT(error_of([&] { config.read("pair", v); }), HasSubstr("3 numbers, not 2"));
  EXPECT_THAT(error_of([&] { config.read("bad", list); }), HasSubstr("'x'"));
  EXPECT_THAT(error_of([&] { config.read("map", number); }), HasSubstr("a mapping"));
  EXPECT_THAT(error_of([&] { config.read("flag", flag); }), HasSubstr("true or false"));
  EXPECT_THAT(error_of([&] { config.require("gone", number); }),
              AllOf(HasSubstr("'gone' is missing")));
  EXPECT_EQ(number, 4.0) << "a refused value must not be stored";
}

TEST(Config, FilesThatAreMissingOrMalformedAreNamed) {
  EXPECT_THAT(error_of([] { Config::load("/nowhere/f.yaml"); }), HasSubstr("/nowhere/f.yaml"));
  EXPECT_THAT(error_of([] { Config::load("/tmp"); }), HasSubstr("cannot be read"));
  EXPECT_THAT(error_of([] { Config::parse("a: [1, 2\nb: 3", "f.yaml"); }),
              AllOf(HasSubstr("f.yaml:2"), HasSubstr("not valid YAML")));
  EXPECT_THAT(error_of([] { Config::parse("- 1\n- 2\n", "f.yaml"); }), HasSubstr("a list"));
  EXPECT_TRUE(Config::parse("", "f.yaml").empty());
  EXPECT_THAT(error_of([] { Config::parse("", "f.yaml").demand("a"); }), HasSubstr("f.yaml:1:"));
  EXPECT_THAT(error_of([] { Config::parse("a: 1\nm: {b: 2, b: 3}\n", "f.yaml"); }),
              AllOf(HasSubstr("f.yaml:2"), HasSubstr("'b' is given twice")));
  EXPECT_THAT(error_of([] { Config::parse("a: &x [*x]\n", "f.yaml"); }),
              AllOf(HasSubstr("f.yaml:1"), HasSubstr("nested")));
}

TEST(Config, TextsWithBracketsAndCommasSurviveADump) {
  const std::vector<std::string> texts{"a,b", "[", "c]", "- d", "#", "e: f", "", "1.5", "'", "\""};
  std::vector<std::string> given = texts;
  const Config none;
  none.read("texts", given);
  given.clear();
  Config::parse(none.dump(), "dump.yaml").read("texts", given);
  EXPECT_EQ(given, texts);
}

TEST(Config, AFileThatGrowsByItsAliasesIsRefusedAtOnce) {
  // Nine to the power of nine values, in nine lines.
  std::string yaml = "a: &a [1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (char name = 'b'; name <= 'i'; ++name) {
    const std::string one = std::string("*") + static_cast<char>(name - 1) + ", ";
    yaml += fmt::format("{0}: &{0} [{1}{1}{1}{1}{1}{1}{1}{1}{1}]\n", name, one);
  }
  EXPECT_THAT(error_of([&] { Config::parse(yaml, "f.yaml"); }),
              AllOf(HasSubstr("f.yaml:"), HasSubstr("aliases included")));
  EXPECT_THAT(error_of([&] { Config().set("key", "{a: 1, a: 2}"); }), HasSubstr("given twice"));
  EXPECT_THAT(error_of([] { Config::parse(std::string(2 << 20, ' '), "f.yaml"); }),
              HasSubstr("f.yaml:1: has 2097152 bytes"));
  EXPECT_THAT(error_of([] { Config::parse("a: " + std::string(100'000, '['), "f.yaml"); }),
              HasSubstr("f.yaml:1"));
}

TEST(Config, ValuesSetByHandWinOverTheFile) {
  Config config = Config::parse("estimator:\n  gate: 1\n", "f.yaml");
  config.set("estimator.gate", "2");
  config.set("planner.speed", "fast");
  double gate = 0;
  double speed = 0;
  config.child("estimator").read("gate", gate);
  EXPECT_EQ(gate, 2);
  EXPECT_THAT(error_of([&] { config.child("planner").read("speed", speed); }),
              AllOf(HasSubstr("planner.speed=fast"), HasSubstr("must be a number")));
  config.set("planner.sped", "1");
  EXPECT_THAT(error_of([&] { config.finish(); }), HasSubstr("'sped'; did you mean 'speed'?"));
}

TEST(Config, StepsAreMappingsOrWordsAndKnowTheirLines) {
  const Config config =
      Config::parse("steps:\n  - land\n  - hold: 5\n  - {a: 1, b: 2}\n  - hopp\n", "f.yaml");
  const std::vector<Config> steps = config.steps("steps");
  ASSERT_EQ(steps.size(), 4u);
  EXPECT_EQ(steps[0].only_key({"land", "hold"}), "land");
  EXPECT_EQ(steps[0].line(), 2);
  EXPECT_NO_THROW(steps[0].require_nothing("land"));
  EXPECT_EQ(steps[1].only_key({"land", "hold"}), "hold");
  EXPECT_EQ(steps[1].line("hold"), 3);
  EXPECT_THAT(error_of([&] { steps[1].require_nothing("hold"); }),
              AllOf(HasSubstr("f.yaml:3"), HasSubstr("not '5'"), HasSubstr("write 'hold' alone")));
  EXPECT_THAT(error_of([&] {
                (void)steps[2].only_key({"a", "b"});
              }),
              AllOf(HasSubstr("f.yaml:4"), HasSubstr("found a and b")));
  EXPECT_THAT(error_of([&] {
                (void)steps[3].only_key({"hop", "land"});
              }),
              AllOf(HasSubstr("f.yaml:5"), HasSubstr("did you mean 'hop'?")));
  EXPECT_THAT(error_of([] { (void)Config::parse("s:\n  - [a]\n", "f.yaml").steps("s"); }),
              AllOf(HasSubstr("f.yaml:2"), HasSubstr("must be a mapping or a word")));
}

TEST(NearestWord, FindsTyposAndNothingElse) {
  EXPECT_EQ(nearest_word("estimater", {"commander", "estimator"}), "estimator");
  EXPECT_EQ(nearest_word("yaw", {"y", "yaw_deg"}), "yaw_deg") << "short for it";
  EXPECT_EQ(nearest_word("zzz", {"commander", "estimator"}), "");
  EXPECT_EQ(nearest_word("x", {}), "");
}

}  // namespace
}  // namespace swiftlet
