// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The player in somebody's hands, in lockstep: what is heard, and when.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/bag/player.hpp"
#include "components/bag/recorder.hpp"
#include "components/topics.hpp"
#include "tests/components/bag/scripted_traffic.hpp"
#include "tests/components/bag/temporary_folder.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr const char* kType = "test::msg::dds_::Blob_";
using Heard = std::pair<int, Duration>;  // which message, and when in the run

/// A recording of 20 s: one message a second on `a`, the number of the second in it, and on the
/// latched topic `map` at 2 s and 12 s.
mcap::Reader recording(const std::filesystem::path& file) {
  auto writer = mcap::Writer::open(file);
  const auto schema = writer->add_schema("test/msg/Blob", "", {});
  const auto a = writer->add_channel("a", "cdr", *schema);
  const auto map = writer->add_channel("map", "cdr", *schema,
                                       {{"offered_qos_profiles", qos_metadata(qos::map)}});
  const auto write = [&](std::uint16_t channel, int second) {
    const mcap::Timestamp time = 1'000'000'000ULL * static_cast<unsigned>(100 + second);
    const Cdr cdr = {0, 1, 0, 0, static_cast<std::uint8_t>(second)};
    EXPECT_TRUE(writer->write(mcap::Message{channel, 0, time, time, cdr}).ok());
  };
  for (int second = 0; second <= 20; ++second) {
    write(*a, second);
    if (second == 2 || second == 12) write(*map, second);
  }
  EXPECT_TRUE(writer->close().ok());
  return mcap::Reader::open(file).value();
}

/// Does something with the player at some times of the run, and ends it at the last.
struct Hand : Component {
  using Act = std::function<void(Player&)>;
  Hand(const ComponentContext& context, Player*& player, std::map<Duration, Act> acts, Duration end)
      : Component(context) {
    for (const auto& [time, act] : acts) {
      call_at(Time(time), [&player, act = act](Time) { act(*player); });
    }
    call_at(Time(end), [this](Time) { stop(0); });
  }
};

struct Ears : Component {
  Ears(const ComponentContext& context, const std::string& wire, const QosProfile& qos)
      : Component(context) {
    subscribe_raw(wire, kType, qos, [this](const Cdr& cdr) {
      heard.emplace_back(cdr.at(4), now().time_since_epoch());
    });
  }
  std::vector<Heard> heard;
};

class PlayerControl : public testing::Test {
 protected:
  void play(std::map<Duration, Hand::Act> acts, Duration end, PlayerParams params = {}) {
    params.stop_at_end = false;
    Host host(lockstep_at());
    Player* player = nullptr;
    auto& a = host.emplace<Ears>("a", "rt/a", qos::state);
    auto& map = host.emplace<Ears>("map", "rt/map", qos::map);
    host.emplace<Hand>("hand", player, std::move(acts), end);
    player = &host.emplace<Player>("player", reader_, params);
    EXPECT_EQ(host.run(), 0);
    a_ = a.heard;
    map_ = map.heard;
    progress_ = player->progress();
  }

  TemporaryFolder folder_;
  mcap::Reader reader_ = recording(folder_ / "f.mcap");
  std::vector<Heard> a_, map_;
  Player::Progress progress_;
};

TEST_F(PlayerControl, APauseMovesAllThatFollows) {
  const auto toggle = [](Player& player) { player.pause_or_resume(); };
  play({{2500ms, toggle}, {9500ms, toggle}}, 11800ms);
  EXPECT_THAT(a_,
              ElementsAre(Heard{0, 0s}, Heard{1, 1s}, Heard{2, 2s}, Heard{3, 10s}, Heard{4, 11s}));
  EXPECT_EQ(progress_.position, 4800ms);
  EXPECT_EQ(progress_.length, 20s);
}

TEST_F(PlayerControl, WhilePausedThePositionStands) {
  play({{2500ms, [](Player& player) { player.pause_or_resume(); }}}, 9s);
  EXPECT_EQ(progress_.position, 2500ms);
  EXPECT_TRUE(progress_.paused);
}

TEST_F(PlayerControl, AStepPlaysOneMessageAndPauses) {
  const auto step = [](Player& player) { player.step(); };
  play({{1500ms, step}, {1600ms, step}, {5s, [](Player& player) { player.pause_or_resume(); }}},
       6500ms);
  EXPECT_THAT(a_, ElementsAre(Heard{0, 0s}, Heard{1, 1s}, Heard{2, 1500ms}, Heard{3, 6s}));
  EXPECT_THAT(map_, ElementsAre(Heard{2, 1600ms})) << "the second step, in the order of the file";
}

TEST_F(PlayerControl, SeekingGoesThereAndShowsTheMapOfThen) {
  play({{3500ms, [](Player& player) { player.seek(10s); }},
        {5200ms, [](Player& player) { player.seek(-5s); }}},
       6500ms);
  // At 3.5 s to 13.5 s; at 5.2 s from 15.2 s to 10.2 s.
  EXPECT_THAT(a_, ElementsAre(Heard{0, 0s}, Heard{1, 1s}, Heard{2, 2s}, Heard{3, 3s}, Heard{14, 4s},
                              Heard{15, 5s}, Heard{11, 6s}));
  EXPECT_THAT(map_, ElementsAre(Heard{2, 2s}, Heard{12, 3500ms}, Heard{2, 5200ms}));
}

TEST_F(PlayerControl, SeekingEndsAtTheEndsOfTheRecording) {
  play({{2500ms, [](Player& player) { player.seek(-60s); }},
        {4800ms, [](Player& player) { player.seek(60s); }},
        {9s, [](Player& player) { player.seek(-5s); }}},
       9500ms);
  EXPECT_THAT(a_, ElementsAre(Heard{0, 0s}, Heard{1, 1s}, Heard{2, 2s}, Heard{0, 2500ms},
                              Heard{1, 3500ms}, Heard{2, 4500ms}, Heard{20, 4800ms}, Heard{15, 9s}))
      << "after the end one can go back";
}

TEST_F(PlayerControl, SeekingWhilePausedStaysPaused) {
  play({{1500ms, [](Player& player) { player.pause_or_resume(); }},
        {2s, [](Player& player) { player.seek(5s); }},
        {3s, [](Player& player) { player.pause_or_resume(); }}},
       4s);
  EXPECT_THAT(a_, ElementsAre(Heard{0, 0s}, Heard{1, 1s}, Heard{7, 3500ms}));
}

TEST_F(PlayerControl, TheRateChangesFromHereOn) {
  play({{2500ms, [](Player& player) { player.scale_rate(2.0); }},
        {3500ms, [](Player& player) { player.scale_rate(0.25); }}},
       6s);
  // 2.5 s to 4.5 s in the first second, then half as fast as recorded.
  EXPECT_THAT(a_, ElementsAre(Heard{0, 0s}, Heard{1, 1s}, Heard{2, 2s}, Heard{3, 2750ms},
                              Heard{4, 3250ms}, Heard{5, 4500ms}));
  EXPECT_EQ(progress_.rate, 0.5);
  EXPECT_EQ(progress_.position, 5750ms);
}

TEST_F(PlayerControl, TopicsCanBeRenamedLeftOutAndGivenAnotherQos) {
  PlayerParams params;
  params.remap = {{"a", "map"}, {"map", "b"}};
  params.qos = {{"a", qos::map}};
  play({}, 1500ms, params);
  EXPECT_THAT(a_, IsEmpty());
  EXPECT_THAT(map_, ElementsAre(Heard{0, 0s}, Heard{1, 1s}));
  params = {};
  params.topics = {"m*"};
  play({}, 5s, params);
  EXPECT_THAT(a_, IsEmpty());
  EXPECT_THAT(map_, ElementsAre(Heard{2, 2s}));
  params.topics = {};
  params.exclude = {"a"};
  play({}, 5s, params);
  EXPECT_THAT(a_, IsEmpty());
  EXPECT_THAT(map_, ElementsAre(Heard{2, 2s}));
}

TEST_F(PlayerControl, ARecordedQosCanBeWeakened) {
  // A reader that asks for transient local hears nothing from a writer that is volatile.
  PlayerParams params;
  params.qos = {{"map", qos::event}};
  play({}, 5s, params);
  EXPECT_THAT(map_, IsEmpty());
  EXPECT_EQ(a_.size(), 5U);
}

/// Notes what the topic clock says, and when.
struct ClockReader : Component {
  explicit ClockReader(const ComponentContext& context) : Component(context) {
    subscribe(topic::clock, [this](const rosgraph_msgs::msg::Clock& clock) {
      const Duration said = std::chrono::seconds(clock.clock().sec()) +
                            std::chrono::nanoseconds(clock.clock().nanosec());
      heard.emplace_back(now().time_since_epoch(), said);
    });
  }
  std::vector<std::pair<Duration, Duration>> heard;
};

TEST_F(PlayerControl, TheClockIsThatOfTheRecording) {
  PlayerParams params;
  params.clock_hz = 10.0;
  params.rate = 2.0;
  params.delay = 1s;
  Host host(lockstep_at());
  Player* player = nullptr;
  auto& clock = host.emplace<ClockReader>("clock");
  const auto toggle = [](Player& hand) { hand.pause_or_resume(); };
  host.emplace<Hand>("hand", player,
                     std::map<Duration, Hand::Act>{{3050ms, toggle}, {4050ms, toggle}}, 5050ms);
  player = &host.emplace<Player>("player", reader_, params);
  ASSERT_EQ(host.run(), 0);
  ASSERT_EQ(clock.heard.size(), 50U);
  for (const auto& [time, said] : clock.heard) {
    const Duration played = time < 1s       ? 0s
                            : time < 3050ms ? (time - 1s) * 2
                            : time < 4050ms ? Duration(4100ms)
                                            : 4100ms + (time - 4050ms) * 2;
    EXPECT_EQ(said, 100s + played) << "at " << to_seconds(time) << " s";
  }
}

TEST_F(PlayerControl, ARecordedClockGivesWayToThatOfThePlayer) {
  auto writer = mcap::Writer::open(folder_ / "clock.mcap");
  const auto schema = writer->add_schema("rosgraph_msgs/msg/Clock", "", {});
  const auto channel = writer->add_channel("/clock", "cdr", *schema);
  const Cdr lie = to_cdr(rosgraph_msgs::msg::Clock());
  for (const mcap::Timestamp second : {1U, 2U, 3U}) {
    const mcap::Timestamp time = second * 1'000'000'000ULL;
    ASSERT_TRUE(writer->write(mcap::Message{*channel, 0, time, time, lie}).ok());
  }
  ASSERT_TRUE(writer->close().ok());
  reader_ = *mcap::Reader::open(folder_ / "clock.mcap");
  PlayerParams params;
  params.clock_hz = 1.0;
  Host host(lockstep_at());
  auto& clock = host.emplace<ClockReader>("clock");
  host.emplace<Player>("player", reader_, params);
  ASSERT_EQ(host.run(), 0);
  for (const auto& [time, said] : clock.heard) EXPECT_GE(said, 1s);
}

}  // namespace
}  // namespace swiftlet
