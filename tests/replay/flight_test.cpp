// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// A flight of the whole stack, recorded, and parts of the stack run again on the recording.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/bag/content_hash.hpp"
#include "components/bag/player.hpp"
#include "components/bag/recorder.hpp"
#include "components/runtime/host.hpp"
#include "components/runtime/message.hpp"
#include "nav_msgs.h"
#include "tests/components/bag/mcap_test_files.hpp"
#include "tests/components/bag/temporary_folder.hpp"
#include "tests/system/system_test.hpp"

namespace swiftlet {
namespace {

class FlightReplay : public test::SystemTest {
 protected:
  void SetUp() override {
    flight_ = path("flight.mcap");
    const test::Finished flown = run({"fly", test::hop(), "--record", flight_});
    ASSERT_TRUE(std::filesystem::exists(flight_)) << flown.err;
    ASSERT_THAT(flown.out, testing::HasSubstr("recording  hash " + *content_hash(flight_)));
  }

  std::vector<mcap::Sample> messages(const std::filesystem::path& file,
                                     const std::vector<std::string>& topics) const {
    mcap::Filter filter;
    filter.topics = topics;
    auto samples = mcap::read_samples(mcap::Reader::open(file).value(), filter);
    for (mcap::Sample& sample : samples) sample.sequence = 0;  // counts within one recording
    return samples;
  }

  /// Replays the flight into a component, and records what that component says.
  std::vector<mcap::Sample> replayed(const std::string& component,
                                     const std::vector<std::string>& topics) const {
    const auto reader = mcap::Reader::open(flight_).value();
    HostOptions options;
    options.lockstep = true;
    options.participant.domain = domain();
    options.start = mcap::to_time(reader.statistics().message_start_time);
    Host host(options);
    host.add(component);
    PlayerParams player;
    for (const Endpoint& endpoint : host.participant()->graph().endpoints()) {
      if (endpoint.is_writer) player.except.push_back(endpoint.topic);
    }
    auto& recorder =
        host.emplace<Recorder>("recorder", RecorderParams{path("replay.mcap"), topics, true});
    host.emplace<Player>("player", reader, player);
    EXPECT_EQ(host.run(), 0);
    EXPECT_TRUE(recorder.close().ok());
    return messages(path("replay.mcap"), topics);
  }

  std::filesystem::path flight_;
};

TEST_F(FlightReplay, TheEstimatorSaysTheSameAgainBitForBit) {
  const std::vector<std::string> topics = {"odometry", "tf"};
  const auto flown = messages(flight_, topics);
  ASSERT_GT(flown.size(), 1000U);
  const auto again = replayed("estimator", topics);
  ASSERT_EQ(again.size(), flown.size());
  for (std::size_t i = 0; i < flown.size(); ++i) ASSERT_EQ(again[i], flown[i]) << "message " << i;
}

TEST_F(FlightReplay, TheMapFileOfAReplayIsTheSameEveryTime) {
  const auto replay = [&](const std::string& name) {
    const test::Finished done =
        run({"replay", flight_, "--into", "lidar_mapper", "--map", path(name)});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return read_bytes(path(name));
  };
  const auto first = replay("first.pgm");
  ASSERT_GT(first.size(), 10'000U);
  EXPECT_TRUE(replay("second.pgm") == first);
}

/// The cells of each map, and its extents.
std::vector<nav_msgs::msg::OccupancyGrid> maps_of(const std::vector<mcap::Sample>& samples) {
  std::vector<nav_msgs::msg::OccupancyGrid> maps;
  for (const mcap::Sample& sample : samples) {
    maps.push_back(from_cdr<nav_msgs::msg::OccupancyGrid>(sample.data).value());
  }
  return maps;
}

TEST_F(FlightReplay, TheMapperDrawsTheMapsOfTheFlight) {
  // A replay begins with the first message, a millisecond after the flight's clock began: each map
  // is that much later, with no scan more.
  const auto flown = maps_of(messages(flight_, {"map"}));
  const auto again = maps_of(replayed("lidar_mapper", {"map"}));
  ASSERT_GT(flown.size(), 40U);
  ASSERT_GE(again.size(), flown.size());
  for (std::size_t i = 0; i < flown.size(); ++i) {
    EXPECT_EQ(again[i].header().stamp().nanosec() - flown[i].header().stamp().nanosec(),
              1'000'000U);
    EXPECT_EQ(again[i].info().origin(), flown[i].info().origin());
    EXPECT_EQ(again[i].info().width(), flown[i].info().width());
    EXPECT_TRUE(again[i].data() == flown[i].data()) << "map " << i;
  }
}

TEST_F(FlightReplay, PlayingTheWholeFlightGivesTheSameRecording) {
  const auto reader = mcap::Reader::open(flight_).value();
  HostOptions options;
  options.lockstep = true;
  options.participant.domain = domain();
  options.start = mcap::to_time(reader.statistics().message_start_time);
  Host host(options);
  host.emplace<Player>("player", reader, PlayerParams{});
  auto& recorder =
      host.emplace<Recorder>("recorder", RecorderParams{path("again.mcap"), {}, false});
  ASSERT_EQ(host.run(), 0);
  ASSERT_TRUE(recorder.close().ok());
  EXPECT_EQ(*content_hash(path("again.mcap")), *content_hash(flight_));
  const auto again = mcap::Reader::open(path("again.mcap")).value();
  EXPECT_EQ(again.statistics().message_count, reader.statistics().message_count);
  ASSERT_EQ(again.schemas().size(), reader.schemas().size());
  std::map<std::string, mcap::Bytes> schemas;
  for (const auto& [id, schema] : reader.schemas()) schemas[schema.name] = schema.data;
  for (const auto& [id, schema] : again.schemas()) EXPECT_EQ(schemas[schema.name], schema.data);
}

TEST_F(FlightReplay, AFullDiskFailsTheFlight) {
  // Files may grow to 300 kB (ulimit counts blocks of 512 bytes).
  const std::string file = path("full.mcap");
  const std::string command = std::string("trap '' XFSZ; ulimit -f 600; exec ") + SWIFTLET_PROGRAM +
                              " fly '" + test::hop() + "' --record '" + file + "'";
  test::Process process = start_command({"sh", "-c", command});
  const auto finished = process.wait(test::kFlightLimit);
  ASSERT_TRUE(finished);
  EXPECT_EQ(finished->exit_code, 1);
  EXPECT_THAT(finished->err, testing::AllOf(testing::HasSubstr("recording stopped"),
                                            testing::HasSubstr("full.mcap")));
  EXPECT_THAT(finished->out, testing::Not(testing::HasSubstr("hash")));
  const auto reader = mcap::Reader::open(file);
  ASSERT_TRUE(reader.ok());
  EXPECT_LE(reader->size(), 600U * 512U);
  EXPECT_GT(reader->statistics().message_count, 1000U) << "what is on the disk stays readable";
}

}  // namespace
}  // namespace swiftlet
