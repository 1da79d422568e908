// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/shell/mission_errand.hpp"

#include <gmock/gmock.h>

#include "components/commander/mission_desk.hpp"
#include "control/flight_director.hpp"

namespace swiftlet::screen {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::HasSubstr;

MissionFile mission_of(int count) {
  MissionFile mission;
  for (int i = 0; i < count; ++i) {
    WrittenItem written;
    written.item.place.position = {0.1 * i, 1.0, 1.2};
    mission.items.push_back(written);
  }
  return mission;
}

/// A vehicle at the other end of a good link.
class MissionErrandTest : public testing::Test {
 protected:
  MissionErrand::Step step() {
    now += 50ms;
    MissionErrand::Step step = errand.advance(now);
    for (const auto& part : step.outgoing.parts) desk.hear(part, director, now);
    if (step.outgoing.fetch) {
      for (const auto& part : desk.answer(*step.outgoing.fetch, now)) errand.hear(part, now);
    }
    errand.hear(desk.state(now), now);
    sent += step.outgoing.parts.size();
    return step;
  }
  MissionErrand::Outcome run() {
    for (int i = 0; i < 1000; ++i) {
      const MissionErrand::Step last = step();
      if (last.outcome) return *last.outcome;
      progress.push_back(last.progress);
    }
    return {};
  }

  Time now{1000s};
  FlightDirector director{FlightDirector::Params()};
  MissionDesk desk{{15.0}};
  MissionErrand errand;
  std::size_t sent = 0;
  std::vector<std::string> progress;
};

TEST_F(MissionErrandTest, BringsAMissionAndFetchesTheSame) {
  const MissionFile mission = mission_of(120);
  errand.bring("a", mission, now);
  EXPECT_TRUE(errand.brings());
  const MissionErrand::Outcome brought = run();
  EXPECT_TRUE(brought.ok);
  EXPECT_EQ(brought.text, "upload: 120 items, read back");
  EXPECT_THAT(progress, Contains("upload: 0 of 120 items"));
  EXPECT_THAT(progress, Contains("upload: 120 of 120 items")) << "while it is read back";
  EXPECT_FALSE(errand.busy());
  EXPECT_FALSE(step().outcome) << "an end is told once";

  errand.fetch(now);
  EXPECT_FALSE(errand.brings());
  const MissionErrand::Outcome fetched = run();
  ASSERT_TRUE(fetched.ok && fetched.fetched);
  EXPECT_EQ(format_mission(MissionForm::kYaml, *fetched.fetched)->text,
            format_mission(MissionForm::kYaml, mission)->text);
}

TEST_F(MissionErrandTest, SaysWhyItFailed) {
  MissionFile mission = mission_of(3);
  mission.items[1].item.hold = -1.0;
  errand.bring("a", mission, now);
  const MissionErrand::Outcome refused = run();
  EXPECT_FALSE(refused.ok);
  EXPECT_THAT(refused.text, HasSubstr("upload: mission refused: item 2"));
  errand.fetch(now);
  EXPECT_EQ(run().text, "download: the vehicle has no mission");
}

TEST_F(MissionErrandTest, WhatIsGivenUpIsNotHeardOfAgain) {
  errand.bring("a", mission_of(200), now);
  step();
  const std::size_t before = sent;
  EXPECT_GT(before, 0u);
  errand.give_up();
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(step().outcome);
  EXPECT_EQ(sent, before);
  EXPECT_TRUE(desk.whole(now).items().empty()) << "as a whole or not at all";
}

}  // namespace
}  // namespace swiftlet::screen
