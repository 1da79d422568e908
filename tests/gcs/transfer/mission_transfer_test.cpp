// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// Missions over a link that loses, delays, repeats, reorders and goes away, between both ends as
// they are.
#include "gcs/transfer/mission_transfer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "components/commander/mission_desk.hpp"
#include "components/commander/mission_message.hpp"
#include "control/flight_director.hpp"
#include "tests/slowdown.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using State = TransferProgress::State;

struct LinkParams {
  double loss = 0.0;
  Duration delay{0};
  Duration jitter{0};
  double repeated = 0.0;
  Time outage_begin{}, outage_end{};
};

/// One direction: what was sent comes out later, or never, or twice.
template <class Message>
class Link {
 public:
  Link(const LinkParams& params, std::mt19937& random) : params_(params), random_(random) {}

  void send(const Message& message, Time now) {
    const bool is_out = now >= params_.outage_begin && now < params_.outage_end;
    if (is_out || chance(params_.loss)) return;
    const int copies = chance(params_.repeated) ? 2 : 1;
    for (int i = 0; i < copies; ++i) {
      const Duration late(std::uniform_int_distribution<std::int64_t>(
          0, std::max<std::int64_t>(1, params_.jitter.count()))(random_));
      flying_.emplace(now + params_.delay + late, message);
    }
  }
  template <class Hear>
  void deliver(Time now, Hear hear) {
    while (!flying_.empty() && flying_.begin()->first <= now) {
      hear(flying_.begin()->second);
      flying_.erase(flying_.begin());
    }
  }

 private:
  bool chance(double probability) { return std::bernoulli_distribution(probability)(random_); }
  const LinkParams& params_;
  std::mt19937& random_;
  std::multimap<Time, Message> flying_;
};

MissionInbox::Items random_mission(std::mt19937& random, std::size_t count) {
  std::uniform_real_distribution<double> place(-50.0, 50.0);
  MissionInbox::Items items;
  for (std::size_t i = 0; i < count; ++i) {
    MissionItem item;
    item.place.position = {place(random), place(random), 1.0 + 0.01 * static_cast<double>(i)};
    if (i % 3 == 0) item.place.yaw = place(random) / 20.0;
    items.push_back(to_msg(item));
  }
  return items;
}

/// A vehicle's mission desk at the other end of a bad link.
struct Far {
  Far(const LinkParams& params, unsigned seed)
      : link(params),
        random(seed),
        up(link, random),
        fetches(link, random),
        states(link, random),
        parts(link, random) {}

  /// A step of 50 ms for both ends.
  void step(MissionUpload* upload, MissionDownload* download) {
    now += 50ms;
    up.deliver(now, [&](const auto& part) { desk.hear(part, director, now); });
    fetches.deliver(now, [&](const auto& fetch) {
      for (const auto& part : desk.answer(fetch, now)) parts.send(part, now);
    });
    if (++steps % 10 == 0) states.send(desk.state(now), now);
    states.deliver(now, [&](const auto& state) {
      if (upload) upload->hear(state, now);
      if (download) download->hear(state, now);
    });
    parts.deliver(now, [&](const auto& part) {
      if (upload) upload->hear(part, now);
      if (download) download->hear(part, now);
    });
    if (upload) {
      const auto outgoing = upload->advance(now);
      for (const auto& part : outgoing.parts) up.send(part, now);
      if (outgoing.fetch) fetches.send(*outgoing.fetch, now);
    }
    if (download) {
      if (const auto fetch = download->advance(now)) fetches.send(*fetch, now);
    }
  }
  TransferProgress run(MissionUpload& upload, Duration limit) {
    for (const Time end = now + limit; now < end && upload.progress().state == State::kRunning;) {
      step(&upload, nullptr);
    }
    return upload.progress();
  }

  LinkParams link;
  std::mt19937 random;
  Time now{100s};
  int steps = 0;
  FlightDirector director{FlightDirector::Params()};
  MissionDesk desk{MissionRunner::Params()};
  Link<swiftlet_msgs::msg::MissionPart> up;
  Link<swiftlet_msgs::msg::MissionFetch> fetches;
  Link<swiftlet_msgs::msg::MissionState> states;
  Link<swiftlet_msgs::msg::MissionPart> parts;
};

TEST(MissionTransfer, AGoodLinkTakesAMomentAndReadsBack) {
  Far far({}, 1);
  const auto items = random_mission(far.random, 200);
  MissionUpload upload("a", items, far.now, {});
  const TransferProgress progress = far.run(upload, 10s);
  EXPECT_EQ(progress.state, State::kDone) << progress.reason;
  EXPECT_LT(far.now, Time(105s));
  EXPECT_EQ(far.desk.whole(far.now).items(), items);
}

/// 20 % loss, 300 ms delay, repeats and another order, and 10 s of nothing: 200 items each time.
TEST(MissionTransfer, ABadLinkBringsTheWholeMissionOrNothing) {
  const unsigned rounds = test::kSlowdown > 1 ? 10 : 100;
  int done = 0;
  for (unsigned seed = 1; seed <= rounds; ++seed) {
    SCOPED_TRACE(seed);
    LinkParams link{0.2, 300ms, 100ms, 0.05, {}, {}};
    link.outage_begin = Time(100s) + std::chrono::milliseconds(53 * seed);
    link.outage_end = link.outage_begin + 10s;
    Far far(link, seed);
    const auto old = random_mission(far.random, 5);
    for (const auto& part : make_parts(far.now, "old", old, {0, 1, 2, 3, 4})) {
      far.desk.hear(part, far.director, far.now);
    }
    const auto items = random_mission(far.random, 200);
    TransferParams params;
    params.patience = 20s;  // they have met already
    MissionUpload upload("new", items, far.now, params);
    std::size_t wrong = 0;
    while (far.now < Time(220s) && upload.progress().state == State::kRunning) {
      far.step(&upload, nullptr);
      const auto there = far.desk.whole(far.now).items();
      if (there != old && there != items) ++wrong;
    }
    EXPECT_EQ(wrong, 0U) << "the vehicle had half a mission";
    if (upload.progress().state == State::kDone) {
      ++done;
      EXPECT_EQ(far.desk.whole(far.now).items(), items);
    }
  }
  EXPECT_EQ(done, static_cast<int>(rounds)) << "with 20 s of patience all of them come through";
}

TEST(MissionTransfer, WithoutAnswersItGivesUpAndSaysWhatIsNotKnown) {
  Far deaf({1.0, 0ms, 0ms, 0.0, {}, {}}, 1);
  MissionUpload upload("a", random_mission(deaf.random, 3), deaf.now, {});
  const TransferProgress progress = deaf.run(upload, 60s);
  EXPECT_EQ(progress.state, State::kFailed);
  EXPECT_THAT(progress.reason, HasSubstr("no vehicle says what mission it has"));
  EXPECT_NEAR(to_seconds(deaf.now - Time(100s)), to_seconds(TransferParams().patience), 0.2);

  // One whose commander hears nothing of it.
  LinkParams good;
  Far half(good, 1);
  MissionUpload lost("b", random_mission(half.random, 3), half.now, {});
  while (lost.progress().state == State::kRunning && half.now < Time(200s)) {
    half.now += 50ms;
    (void)lost.advance(half.now);
    lost.hear(half.desk.state(half.now), half.now);
  }
  EXPECT_EQ(lost.progress().state, State::kFailed);
  EXPECT_THAT(lost.progress().reason, HasSubstr("has not confirmed the mission"));
}

TEST(MissionTransfer, ARefusalComesWithItsReasonAndTheOldMissionStays) {
  Far far({}, 1);
  auto items = random_mission(far.random, 3);
  MissionUpload good("good", items, far.now, {});
  ASSERT_EQ(far.run(good, 10s).state, State::kDone);
  auto bad_items = items;
  bad_items[1].hold(-1.0);
  MissionUpload bad("bad", bad_items, far.now, {});
  const TransferProgress progress = far.run(bad, 10s);
  EXPECT_EQ(progress.state, State::kFailed);
  EXPECT_EQ(progress.reason, "mission refused: item 2: a hold of -1 s cannot be flown");
  EXPECT_EQ(far.desk.whole(far.now).items(), items);
}

TEST(MissionTransfer, DamageOnTheWayIsRefused) {
  Far far({}, 1);
  const auto items = random_mission(far.random, 4);
  auto parts = make_parts(far.now, "a", items, {0, 1, 2, 3});
  parts.front().items().front().place().position().x(17.0);
  far.desk.hear(parts.front(), far.director, far.now);
  const auto state = far.desk.state(far.now);
  EXPECT_TRUE(state.upload_refused());
  EXPECT_THAT(state.upload_reason(), HasSubstr("checksum is wrong"));
  EXPECT_EQ(state.count(), 0U);
}

TEST(MissionTransfer, TheSameUploadAgainChangesNothing) {
  Far far({}, 1);
  const auto items = random_mission(far.random, 20);
  MissionUpload first("a", items, far.now, {});
  ASSERT_EQ(far.run(first, 10s).state, State::kDone);
  const auto before = far.desk.state(far.now);
  MissionUpload again("a", items, far.now, {});
  ASSERT_EQ(far.run(again, 10s).state, State::kDone);
  EXPECT_FALSE(differs(before, far.desk.state(far.now)));
}

TEST(MissionTransfer, APartFitsIntoADatagram) {
  std::mt19937 random(1);
  const auto items = random_mission(random, 100);
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < 100; ++i) all.push_back(i);
  for (const auto& part : make_parts(Time(1s), std::string(40, 'x'), items, all)) {
    EXPECT_LT(to_cdr(part).size(), 1200U);
  }
}

TEST(MissionTransfer, DownloadsWhatTheVehicleHas) {
  Far far({0.3, 200ms, 100ms, 0.1, {}, {}}, 7);
  const auto items = random_mission(far.random, 150);
  MissionUpload upload("a", items, far.now, {});
  ASSERT_EQ(far.run(upload, 120s).state, State::kDone);
  MissionDownload download(far.now, {});
  while (download.progress().state == State::kRunning) far.step(nullptr, &download);
  ASSERT_EQ(download.progress().state, State::kDone) << download.progress().reason;
  EXPECT_EQ(download.items(), items);
  EXPECT_EQ(download.id(), "a");

  Far empty({}, 1);
  MissionDownload none(empty.now, {});
  while (none.progress().state == State::kRunning) empty.step(nullptr, &none);
  EXPECT_EQ(none.progress().reason, "the vehicle has no mission");
}

}  // namespace
}  // namespace swiftlet
