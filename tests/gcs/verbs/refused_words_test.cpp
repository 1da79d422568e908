// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// What cannot be done is refused before anybody is asked: with exit code 2, what is wrong, and what
// to do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "gcs/gcs_commands.hpp"

namespace swiftlet {
namespace {

using testing::HasSubstr;
using Words = std::vector<std::string>;

struct Outcome {
  int code = 0;
  std::string err;
};

/// As `swiftlet gcs` with these words.
Outcome run(Words words) {
  CLI::App gcs("test");
  add_gcs_commands(gcs);
  std::reverse(words.begin(), words.end());  // as CLI11 wants them
  Outcome outcome;
  testing::internal::CaptureStderr();
  try {
    gcs.parse(words);
  } catch (const CLI::RuntimeError& error) {
    outcome.code = error.get_exit_code();
  } catch (const CLI::ParseError& error) {
    outcome.code = 2;  // as the program has it
    std::fputs(error.what(), stderr);
  }
  std::fflush(stderr);
  outcome.err = testing::internal::GetCapturedStderr();
  return outcome;
}

void expect_refused(const Words& words, const std::string& why) {
  const Outcome outcome = run(words);
  EXPECT_EQ(outcome.code, 2) << testing::PrintToString(words);
  EXPECT_THAT(outcome.err, HasSubstr(why)) << testing::PrintToString(words);
}

TEST(RefusedWords, FilesThatCannotBeWritten) {
  expect_refused({"map", "save", "map.jpg"}, "map.jpg: a map is saved as .pgm or .png");
  expect_refused({"map", "save", "/no/such/folder/map.pgm"},
                 "there is no folder /no/such/folder; make it first");
  expect_refused({"map", "save"}, "file is required");
  expect_refused({"cloud", "save", "cloud.las"}, "a cloud is saved as .ply or .pcd");
  expect_refused({"cloud", "save", "/no/such/folder/a.ply"}, "make it first");
  expect_refused({"cloud", "save", "a.ply", "--topic", "1st"}, "--topic");
  expect_refused({"cloud", "save", "a.ply", "--voxel", "nan"}, "no number from");
  expect_refused({"cloud", "save", "a.ply", "--seconds", "-1"}, "--seconds");
}

TEST(RefusedWords, Modes) {
  expect_refused({"mode", "xylophone"}, "there are Takeoff, Hover, Land");
  expect_refused({"mode", "indoor", "navigation"}, "swiftlet gcs goto X Y [Z]");
  expect_refused({"mode", "takeoff", "--altitude", "nan"}, "no number from");
}

TEST(RefusedWords, Numbers) {
  expect_refused({"waypoint", "add", "1", "2"}, "z is required");
  expect_refused({"waypoint", "add", "1", "2", "inf"}, "no number from");
  expect_refused({"waypoint", "move", "0", "1", "2", "3"}, "number");
  expect_refused({"waypoint", "remove", "last"}, "number");
  expect_refused({"waypoint"}, "subcommand");
  expect_refused({"battery", "--seconds", "0"}, "--seconds");
  expect_refused({"log", "--for", "nan"}, "no number from");
  expect_refused({"map", "show", "--width", "3"}, "--width");
}

TEST(RefusedWords, AMissionThatCannotBeFlownIsNotFollowed) {
  expect_refused({"follow", "/no/such/mission.yaml"}, "/no/such/mission.yaml");
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) /
                                     ("swiftlet-follow-" + std::to_string(getpid()) + ".yaml");
  std::FILE* stream = std::fopen(file.c_str(), "w");
  ASSERT_NE(stream, nullptr);
  std::fputs("items:\n  - takeoff: 0\n", stream);
  std::fclose(stream);
  expect_refused({"follow", file.string()}, "the mission was not sent");
  expect_refused({"follow", file.string()}, file.string() + ":2: item 1");
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace swiftlet
