// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/serial_link/link_outbox.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

using Payload = LinkOutbox::Payload;

/// A line of a clock that the test moves on by a millisecond.
struct Line {
  LinkOutbox outbox{LinkOutbox::Params()};
  Time now{std::chrono::seconds(100)};
  std::vector<std::pair<Time, LinkFrame>> sent;
  FrameDecoder decoder;

  void run(Duration duration) {
    for (const Time end = now + duration; now < end; now += 1ms) {
      const auto bytes = outbox.next(now);
      if (!bytes) continue;
      for (const std::uint8_t byte : *bytes) {
        if (const LinkFrame* frame = decoder.take(byte)) sent.emplace_back(now, *frame);
      }
    }
  }
  std::vector<FrameType> types() const {
    std::vector<FrameType> all;
    for (const auto& [time, frame] : sent) all.push_back(frame.type);
    return all;
  }
  std::map<FrameType, int> counts() const {
    std::map<FrameType, int> all;
    for (const FrameType type : types()) ++all[type];
    return all;
  }
  Status telemetry(std::uint8_t mark, std::size_t size = 200) {
    return outbox.offer_telemetry(Payload(size, mark));
  }
  Status command(const std::string& id) { return outbox.offer_command(id, Payload(60, 1), now); }
};

TEST(LinkOutbox, OnlyTheNewestTelemetryWaits) {
  Line line;
  for (std::uint8_t mark = 1; mark <= 9; ++mark) ASSERT_TRUE(line.telemetry(mark).ok());
  line.run(1ms);
  ASSERT_EQ(line.sent.size(), 1u);
  EXPECT_EQ(line.sent[0].second.payload, Payload(200, 9));
  EXPECT_EQ(line.outbox.counts().outdated, 8u);
}

TEST(LinkOutbox, NeverSendsMoreThanTheLineCarries) {
  Line line;
  for (int second = 0; second < 20; ++second) {
    const std::uint64_t before = line.outbox.counts().bytes;
    for (int k = 0; k < 100; ++k) {
      ASSERT_TRUE(line.telemetry(1).ok());
      line.run(10ms);
    }
    const std::uint64_t sent = line.outbox.counts().bytes - before;
    EXPECT_LE(sent, 1920u + kMaxFrameBytes);
    EXPECT_GE(sent, 1600u);
  }
}

TEST(LinkOutbox, FiveTelemetryMessagesASecondLeaveNearlyHalfOfTheLine) {
  Line line;
  for (int k = 0; k < 50; ++k) {
    ASSERT_TRUE(line.telemetry(1).ok());
    line.run(200ms);
  }
  EXPECT_EQ(line.outbox.counts().outdated, 0u);
  EXPECT_EQ(line.counts()[FrameType::kTelemetry], 50);
  EXPECT_LE(line.outbox.counts().bytes, 10.0 * 0.55 * 1920.0);
}

TEST(LinkOutbox, CommandsAndAcknowledgementsGoFirst) {
  Line line;
  ASSERT_TRUE(line.telemetry(1).ok());
  ASSERT_TRUE(line.command("a").ok());
  ASSERT_TRUE(line.outbox.offer_acknowledgement("b", Payload(20, 2)).ok());
  line.run(200ms);
  EXPECT_THAT(line.types(),
              ElementsAre(FrameType::kAcknowledgement, FrameType::kCommand, FrameType::kTelemetry));
  // A command waits for no more than the frame that is under way.
  ASSERT_TRUE(line.telemetry(1).ok());
  line.run(1ms);
  const Time asked = line.now;
  ASSERT_TRUE(line.command("c").ok());
  ASSERT_TRUE(line.telemetry(2).ok());
  line.run(200ms);
  const auto first = std::find_if(line.sent.begin(), line.sent.end(), [&](const auto& entry) {
    return entry.first >= asked && entry.second.type == FrameType::kCommand;
  });
  ASSERT_NE(first, line.sent.end());
  EXPECT_LE(to_seconds(first->first - asked), frame_bytes(200) / 1920.0 + 0.002);
}

TEST(LinkOutbox, ACommandIsRepeatedUntilItIsAcknowledged) {
  Line line;
  ASSERT_TRUE(line.command("a").ok());
  line.run(600ms);
  EXPECT_EQ(line.counts()[FrameType::kCommand], 3);
  line.outbox.acknowledged("a");
  line.run(600ms);
  EXPECT_EQ(line.counts()[FrameType::kCommand], 3);
}

TEST(LinkOutbox, ACommandThatIsOfferedOftenIsSentAtItsPeriodAndNeverLate) {
  Line line;
  for (int k = 0; k < 20; ++k) {
    ASSERT_TRUE(line.command("a").ok());
    line.run(100ms);
  }
  EXPECT_EQ(line.counts()[FrameType::kCommand], 8);
  const Time asked = line.now - 100ms;
  line.run(10s);
  const auto is_command = [](const auto& entry) {
    return entry.second.type == FrameType::kCommand;
  };
  const auto last = std::find_if(line.sent.rbegin(), line.sent.rend(), is_command);
  EXPECT_LE(to_seconds(last->first - asked), 1.5) << "its sender has given up by then";
  EXPECT_EQ(line.outbox.commands(), 0u);
  EXPECT_EQ(line.outbox.counts().given_up, 1u);
}

TEST(LinkOutbox, AFloodOfCommandsDoesNotSilenceTelemetryAndTakesNoMemory) {
  Line line;
  for (int k = 0; k < 1000; ++k) {
    ASSERT_TRUE(line.command(std::to_string(k)).ok());
    if (k % 20 == 0) {
      ASSERT_TRUE(line.telemetry(1).ok());
    }
    line.run(10ms);
    EXPECT_LE(line.outbox.commands(), 8u);
  }
  EXPECT_GE(line.counts()[FrameType::kTelemetry], 25) << "of 50 in 10 s";
}

TEST(LinkOutbox, ASilentLineSaysHelloEachSecond) {
  Line line;
  line.run(10s);
  EXPECT_THAT(line.types(), testing::Each(FrameType::kHello));
  EXPECT_NEAR(static_cast<double>(line.sent.size()), 10.0, 1.0);
}

TEST(LinkOutbox, WhatDoesNotFitIsRefused) {
  Line line;
  EXPECT_TRUE(line.telemetry(1, kMaxPayload).ok());
  const Status refused = line.telemetry(1, kMaxPayload + 1);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().reason, HasSubstr("248 bytes does not fit"));
  EXPECT_FALSE(line.outbox.offer_command("a", Payload(300), line.now).ok());
  EXPECT_FALSE(line.outbox.offer_acknowledgement("a", Payload(300)).ok());
}

}  // namespace
}  // namespace swiftlet
