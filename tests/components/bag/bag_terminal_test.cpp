// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Recording and playing with a person at the keyboard, played by a pty.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <regex>

#include "components/bag/mcap/reader.hpp"
#include "components/bag/mcap/writer.hpp"
#include "tests/components/bag/pty_process.hpp"
#include "tests/system/system_test.hpp"

namespace swiftlet {
namespace {

using testing::HasSubstr;

constexpr const char* kRight = "\x1b[C";
constexpr const char* kLeft = "\x1b[D";

class BagTerminal : public test::SystemTest {
 protected:
  BagTerminal() {
    // Ten minutes with one message a second.
    auto writer = mcap::Writer::open(file_);
    const auto schema = writer->add_schema("test/msg/Blob", "", {});
    const auto channel = writer->add_channel("a", "cdr", *schema);
    const mcap::Bytes cdr = {0, 1, 0, 0};
    for (mcap::Timestamp second = 1; second <= 601; ++second) {
      const mcap::Timestamp time = second * 1'000'000'000;
      EXPECT_TRUE(writer->write(mcap::Message{*channel, 0, time, time, cdr}).ok());
    }
    EXPECT_TRUE(writer->close().ok());
  }

  test::PtyProcess play(std::vector<std::string> more = {}) {
    std::vector<std::string> command = {SWIFTLET_PROGRAM, "bag",     "play",
                                        file_.string(),   "--delay", "0"};
    command.insert(command.end(), more.begin(), more.end());
    return {command, environment_};
  }

  /// What the status line says last.
  struct Status {
    bool paused = false;
    double position_s = -1.0;
    double rate = 0.0;
    int messages = 0;
  };
  static Status status_of(test::PtyProcess& player) {
    static const std::regex kLine(
        R"((playing|paused ) ([0-9.]+) of 600\.00 s, rate ([0-9.]+), ([0-9]+) messages)");
    Status status;
    const std::string& screen = player.screen();
    for (std::sregex_iterator match(screen.begin(), screen.end(), kLine), end; match != end;
         ++match) {
      status = {(*match)[1] == "paused ", std::stod((*match)[2]), std::stod((*match)[3]),
                std::stoi((*match)[4])};
    }
    return status;
  }
  template <class Condition>
  static bool becomes(test::PtyProcess& player, Condition condition) {
    return test::becomes_true(test::kStartLimit, [&] { return condition(status_of(player)); });
  }

  std::filesystem::path file_ = path("f.mcap");
};

TEST_F(BagTerminal, KeysSteerThePlayer) {
  test::PtyProcess player = play();
  ASSERT_TRUE(becomes(player, [](const Status& now) { return now.position_s > 0.0; }))
      << player.screen();
  EXPECT_FALSE(player.is_cooked());
  player.press(" ");
  ASSERT_TRUE(becomes(player, [](const Status& now) { return now.paused; }));
  const Status paused = status_of(player);

  player.press(std::string(kRight) + kRight + kRight);
  ASSERT_TRUE(becomes(player, [&](const Status& now) {
    return std::abs(now.position_s - paused.position_s - 15.0) < 0.02;
  })) << player.screen();
  player.press(kLeft);
  ASSERT_TRUE(becomes(player, [&](const Status& now) {
    return std::abs(now.position_s - paused.position_s - 10.0) < 0.02;
  }));
  const int before = status_of(player).messages;
  player.press("s.s");
  ASSERT_TRUE(becomes(player, [&](const Status& now) { return now.messages == before + 3; }));
  EXPECT_TRUE(status_of(player).paused);
  const double stepped_to = status_of(player).position_s;
  EXPECT_EQ(stepped_to, std::round(stepped_to)) << "the time of a message";

  player.press("+++");
  ASSERT_TRUE(becomes(player, [](const Status& now) { return now.rate > 1.9; }));
  player.press("---");
  ASSERT_TRUE(becomes(player, [](const Status& now) { return now.rate == 1.0; }));
  player.press(" ");
  ASSERT_TRUE(becomes(
      player, [&](const Status& now) { return !now.paused && now.position_s > stepped_to; }));
  player.press("q");
  EXPECT_EQ(player.wait(test::kExitLimit), 0);
  EXPECT_TRUE(player.is_cooked());
  EXPECT_THAT(player.screen(), HasSubstr("played "));
}

TEST_F(BagTerminal, WhateverEndsThePlayerTheTerminalIsAsBefore) {
  const std::string ctrl_c = "\x03", ctrl_backslash = "\x1c";
  struct Case {
    std::string keys;
    int signal;
    int exit_code;
  };
  for (const Case& end :
       {Case{ctrl_c, 0, 0}, Case{"", SIGTERM, 0}, Case{"", SIGHUP, 128 + SIGHUP},
        Case{"", SIGABRT, 128 + SIGABRT}, Case{ctrl_backslash, 0, 128 + SIGQUIT}}) {
    test::PtyProcess player = play();
    ASSERT_TRUE(player.is_cooked() || player.shows("playing"));
    ASSERT_TRUE(player.shows("playing")) << player.screen();
    ASSERT_FALSE(player.is_cooked());
    if (!end.keys.empty()) player.press(end.keys);
    if (end.signal != 0) player.send(end.signal);
    EXPECT_EQ(player.wait(test::kExitLimit), end.exit_code) << "signal " << end.signal;
    EXPECT_TRUE(player.is_cooked()) << "signal " << end.signal;
  }
}

TEST_F(BagTerminal, CtrlZGivesTheTerminalBackAndForegroundTakesItAgain) {
  test::PtyProcess player = play();
  ASSERT_TRUE(player.shows("playing"));
  player.send(SIGTSTP);
  // A session's only process group is orphaned, which SIGTSTP does not stop: look at the terminal.
  EXPECT_TRUE(test::becomes_true(test::kStartLimit, [&] { return player.is_cooked(); }));
  player.send(SIGCONT);
  EXPECT_TRUE(test::becomes_true(test::kStartLimit, [&] { return !player.is_cooked(); }));
  player.press("q");
  EXPECT_EQ(player.wait(test::kExitLimit), 0);
  EXPECT_TRUE(player.is_cooked());
}

TEST_F(BagTerminal, WithoutATerminalKeysAreNotWaitedForAndNoStatusIsPrinted) {
  const auto finished = run({"bag", "play", file_.string(), "--delay", "0", "--rate", "1000"});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.out, "played 601 messages\n");
}

TEST_F(BagTerminal, TheRecorderSaysHowItGoesAndSavesAWindowAtAKey) {
  test::PtyProcess recorder(
      {SWIFTLET_PROGRAM, "bag", "record", "-o", path("last.mcap"), "--window", "5s", "a"},
      environment_);
  ASSERT_TRUE(recorder.shows("keeping the last 5 s"));
  test::Process player = start({"bag", "play", file_.string(), "--rate", "20"});
  static const std::regex kSome("[1-9][0-9]* messages of 1 topics");
  ASSERT_TRUE(test::becomes_true(test::kStartLimit, [&] {
    return std::regex_search(recorder.screen(), kSome);
  })) << recorder.screen();
  EXPECT_TRUE(recorder.shows("nothing lost"));
  recorder.press("s");
  ASSERT_TRUE(recorder.shows(" saved ")) << recorder.screen();
  EXPECT_TRUE(recorder.shows("1 saved (s saves)"));
  recorder.press("\x03");
  EXPECT_EQ(recorder.wait(test::kExitLimit), 0);
  EXPECT_TRUE(recorder.is_cooked());
  std::vector<std::filesystem::path> saved;
  for (const auto& entry : std::filesystem::directory_iterator(folder())) {
    if (entry.path().filename().string().rfind("last_", 0) == 0) saved.push_back(entry.path());
  }
  ASSERT_EQ(saved.size(), 1U);
  const auto reader = mcap::Reader::open(saved[0]);
  ASSERT_TRUE(reader.ok());
  EXPECT_TRUE(reader->finished());
  EXPECT_GT(reader->statistics().message_count, 0U);
}

}  // namespace
}  // namespace swiftlet
