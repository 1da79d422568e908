// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The player in lockstep on real Fast DDS.
#include "components/bag/player.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/bag/content_hash.hpp"
#include "components/bag/recorder.hpp"
#include "components/runtime/names.hpp"
#include "tests/components/bag/scripted_traffic.hpp"
#include "tests/components/bag/temporary_folder.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using testing::IsEmpty;
using testing::SizeIs;

const std::vector<ScriptedTopic> kTopics = {{"rt/a", "test::msg::dds_::Blob_"},
                                            {"rt/b", "test::msg::dds_::Blob_"},
                                            {"rt/c", "test::msg::dds_::Blob_"}};

/// Messages on the topics a, b and c of type test/msg/Blob, as samples of CDR.
std::vector<Sample> blobs(unsigned seed, std::size_t count, mcap::Timestamp jitter) {
  auto samples = mcap::random_samples(seed, count, jitter);
  for (Sample& sample : samples) sample.data.insert(sample.data.begin(), {0, 1, 0, 0});
  return samples;
}

class PlayerTest : public testing::Test {
 protected:
  mcap::Reader written(const std::vector<Sample>& samples, std::uint64_t chunk_size = 4000) {
    mcap::WriterParams params;
    params.chunk_size = chunk_size;
    mcap::write_samples(file_, samples, params);
    return mcap::Reader::open(file_).value();
  }

  /// What arrives when a recording is played from its own start on.
  std::vector<Sample> play(const mcap::Reader& reader, const PlayerParams& params = {},
                           std::size_t enough = SIZE_MAX) {
    Host host(lockstep_at(mcap::to_time(reader.statistics().message_start_time)));
    auto& listener = host.emplace<Listener>("listener", kTopics, enough);
    auto& player = host.emplace<Player>("player", reader, params);
    EXPECT_EQ(host.run(), 0);
    played_ = player.played();
    damaged_ = player.damaged_chunks();
    return without_sequence(listener.heard());
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "f.mcap";
  std::uint64_t played_ = 0;
  std::uint64_t damaged_ = 0;
};

/// Samples as they are heard: in the order of their log times, published when logged.
std::vector<Sample> as_heard(const std::vector<Sample>& samples) {
  auto heard = without_sequence(mcap::by_time(samples));
  for (Sample& sample : heard) sample.publish_time = sample.log_time;
  return heard;
}

TEST_F(PlayerTest, MessagesComeInTheOrderAndAtTheTimesOfTheRecording) {
  const auto samples = blobs(1, 800, 20'000);  // not in order in the file
  EXPECT_EQ(play(written(samples)), as_heard(samples));
  EXPECT_EQ(played_, samples.size());
  EXPECT_EQ(damaged_, 0U);
}

/// Answers each message of topic a with one on topic d, at once.
struct Answer : Component {
  explicit Answer(const ComponentContext& context) : Component(context) {
    writer_ = advertise_raw("rt/d", "test::msg::dds_::Blob_", qos::state);
    subscribe_raw("rt/a", "test::msg::dds_::Blob_", qos::state,
                  [this](const Cdr& cdr) { writer_->write(cdr); });
  }
  std::shared_ptr<Writer> writer_;
};

TEST_F(PlayerTest, WhatAMessageSetsOffComesBeforeTheNextMessageOfTheSameTime) {
  std::vector<Sample> samples;
  for (const char* topic : {"a", "b", "a"}) samples.push_back({topic, 0, 1000, 1000, {0, 1, 0, 0}});
  const mcap::Reader reader = written(samples);
  Host host(lockstep_at(Time(1000ns)));
  std::vector<ScriptedTopic> topics = kTopics;
  topics.push_back({"rt/d", "test::msg::dds_::Blob_"});
  auto& listener = host.emplace<Listener>("listener", topics);
  host.emplace<Answer>("answer");
  host.emplace<Player>("player", reader, PlayerParams{});
  ASSERT_EQ(host.run(), 0);
  std::string order;
  for (const Sample& sample : listener.heard()) order += sample.topic;
  EXPECT_EQ(order, "adbad");
}

TEST_F(PlayerTest, RecordingWhatIsPlayedGivesTheSameRecording) {
  // The samples of a recorder, so that log and publish times are equal.
  auto samples = blobs(2, 2000, 0);
  for (Sample& sample : samples) sample.publish_time = sample.log_time;
  const mcap::Reader reader = written(samples);
  Host host(lockstep_at(mcap::to_time(reader.statistics().message_start_time)));
  host.emplace<Player>("player", reader, PlayerParams{});
  auto& recorder = host.emplace<Recorder>("recorder", RecorderParams{folder_ / "g.mcap", {}, {}});
  ASSERT_EQ(host.run(), 0);
  ASSERT_TRUE(recorder.close().ok());
  const auto again = mcap::Reader::open(folder_ / "g.mcap");
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(without_sequence(mcap::read_samples(*again)),
            without_sequence(mcap::read_samples(reader)));
  EXPECT_EQ(*content_hash(folder_ / "g.mcap"), *content_hash(file_));
}

TEST_F(PlayerTest, RateDividesTheTimesAndKeepsTheOrder) {
  const auto samples = blobs(3, 300, 20'000);
  for (const double rate : {0.25, 3.0, 1000.0}) {
    PlayerParams params;
    params.rate = rate;
    const auto heard = play(written(samples), params);
    const auto expected = as_heard(samples);
    ASSERT_EQ(heard.size(), expected.size());
    const mcap::Timestamp first = expected.front().log_time;
    for (std::size_t i = 0; i < heard.size(); ++i) {
      EXPECT_EQ(heard[i].topic, expected[i].topic);
      EXPECT_EQ(heard[i].data, expected[i].data);
      const double due = static_cast<double>(expected[i].log_time - first) / rate;
      EXPECT_NEAR(static_cast<double>(heard[i].log_time - first), due, 1.0);
    }
  }
}

TEST_F(PlayerTest, StartSkipsWhatWasBefore) {
  const auto samples = blobs(4, 300, 0);
  PlayerParams params;
  params.start = 50'500ns;
  auto expected = as_heard(samples);
  const mcap::Timestamp begin = expected.front().log_time;
  const mcap::Timestamp skip = 50'500;
  expected.erase(
      std::remove_if(expected.begin(), expected.end(),
                     [&](const Sample& sample) { return sample.log_time < begin + skip; }),
      expected.end());
  ASSERT_THAT(expected, testing::Not(SizeIs(300)));
  for (Sample& sample : expected) sample.log_time = sample.publish_time = sample.log_time - skip;
  EXPECT_EQ(play(written(samples), params), expected);
}

TEST_F(PlayerTest, DelayComesFirst) {
  const auto samples = blobs(5, 30, 0);
  PlayerParams params;
  params.delay = 3s;
  auto expected = as_heard(samples);
  for (Sample& sample : expected) sample.log_time = sample.publish_time += 3'000'000'000U;
  EXPECT_EQ(play(written(samples), params), expected);
}

TEST_F(PlayerTest, LoopPlaysTheSameAgain) {
  const auto samples = blobs(6, 50, 0);
  PlayerParams params;
  params.loop = true;
  const auto heard = play(written(samples), params, 175);
  ASSERT_THAT(heard, SizeIs(175));
  const auto once = as_heard(samples);
  for (std::size_t i = 0; i < heard.size(); ++i) {
    const Sample& expected = once[i % once.size()];
    EXPECT_EQ(heard[i].topic, expected.topic);
    EXPECT_EQ(heard[i].data, expected.data);
    // Distances in time are those of the recording, in each round.
    const Sample& begin = heard[i - i % once.size()];
    EXPECT_EQ(heard[i].log_time - begin.log_time, expected.log_time - once.front().log_time);
    EXPECT_GE(heard[i].log_time, heard[i == 0 ? 0 : i - 1].log_time);
  }
  EXPECT_GT(heard[50].log_time, heard[49].log_time);
}

TEST_F(PlayerTest, ALoopOfOneMomentLetsTimePass) {
  PlayerParams params;
  params.loop = true;
  const auto heard = play(written({{"a", 0, 1000, 1000, {0, 1, 0, 0}}}), params, 5);
  ASSERT_THAT(heard, SizeIs(5));
  EXPECT_GT(heard[4].log_time, heard[3].log_time);
}

TEST_F(PlayerTest, NothingBehindTheStartEndsTheRunEvenInALoop) {
  for (const bool loop : {false, true}) {
    PlayerParams params;
    params.start = 3600s;
    params.loop = loop;
    EXPECT_THAT(play(written(blobs(7, 30, 0)), params), IsEmpty());
  }
}

TEST_F(PlayerTest, TopicsAndExceptionsChoose) {
  const auto samples = blobs(8, 300, 0);
  const mcap::Reader reader = written(samples);
  const auto only = [&](const std::string& topics) {
    std::vector<Sample> expected;
    for (Sample& sample : as_heard(samples)) {
      if (topics.find(sample.topic) != std::string::npos) expected.push_back(std::move(sample));
    }
    return expected;
  };
  PlayerParams params;
  params.topics = {"a", "/c"};
  EXPECT_EQ(play(reader, params), only("ac"));
  params.except = {"rt/c"};
  EXPECT_EQ(play(reader, params), only("a"));
  params.topics.clear();
  EXPECT_EQ(play(reader, params), only("ab"));
  params.except = {"rt/a", "rt/b", "rt/c"};
  EXPECT_THAT(play(reader, params), IsEmpty()) << "and the run ends";
}

TEST_F(PlayerTest, AVehicleIsPutBeforeTheTopics) {
  const mcap::Reader reader = written(blobs(9, 30, 0));
  HostOptions options = lockstep_at();
  options.vehicle = "uav1";
  Host host(options);
  host.emplace<Player>("player", reader, PlayerParams{});
  std::vector<std::string> topics;
  for (const Endpoint& endpoint : host.participant()->graph().endpoints()) {
    topics.push_back(endpoint.topic);
  }
  EXPECT_THAT(topics, testing::UnorderedElementsAre("rt/uav1/a", "rt/uav1/b", "rt/uav1/c"));
}

TEST_F(PlayerTest, ADamagedChunkCostsItsOwnMessagesAndIsCounted) {
  const auto samples = blobs(10, 800, 0);
  const auto chunk = written(samples).chunks()[1];
  auto bytes = read_bytes(file_);
  bytes.at(chunk.chunk_start_offset + chunk.chunk_length / 2) ^= 0x40;
  std::ofstream(file_, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
  const mcap::Reader reader = *mcap::Reader::open(file_);
  std::vector<Sample> left;
  auto cursor = reader.messages();
  for (;;) {
    const auto next = cursor.next();
    if (!next.ok()) continue;
    if (!*next) break;
    const mcap::Message& message = (*next)->message;
    left.push_back(
        {(*next)->channel->topic, 0, message.log_time, message.log_time, message.data.copy()});
  }
  ASSERT_THAT(left.size(), testing::AllOf(testing::Gt(600U), testing::Lt(800U)));
  EXPECT_EQ(play(reader), left);
  EXPECT_EQ(damaged_, 1U);
}

/// Writes channels as they come from elsewhere.
class ForeignFile {
 public:
  explicit ForeignFile(const std::filesystem::path& path)
      : path_(path), writer_(mcap::Writer::open(path).value()) {}
  void add(const std::string& topic, const std::string& encoding, const std::string& type,
           const std::string& qos_profile = "", const Cdr& cdr = {0, 1, 0, 0}) {
    const std::uint16_t schema =
        type.empty() ? std::uint16_t{0} : writer_.add_schema(type, "", std::string_view()).value();
    const auto channel =
        writer_.add_channel(topic, encoding, schema, {{"offered_qos_profiles", qos_profile}});
    ASSERT_TRUE(writer_.write(mcap::Message{*channel, 0, 1000, 1000, cdr}).ok());
  }
  mcap::Reader close() {
    EXPECT_TRUE(writer_.close().ok());
    return mcap::Reader::open(path_).value();
  }

 private:
  std::filesystem::path path_;
  mcap::Writer writer_;
};

TEST_F(PlayerTest, WhatCannotTravelIsLeftOutAndTheRestIsPlayed) {
  ForeignFile file(file_);
  file.add("a", "cdr", "test/msg/Blob");
  file.add("json", "json", "test/msg/Blob");
  file.add("untyped", "cdr", "");
  file.add("", "cdr", "test/msg/Blob");
  file.add("/", "cdr", "test/msg/Blob");
  file.add("no topic", "cdr", "test/msg/Blob");
  file.add("/a", "cdr", "test/msg/Other");  // a second type on the same topic
  file.add("/b", "cdr", "test/msg/Blob");   // as rosbag2 writes it
  std::vector<std::string> topics;
  for (const Sample& sample : play(file.close())) topics.push_back(sample.topic);
  EXPECT_THAT(topics, testing::ElementsAre("a", "b"));
}

TEST_F(PlayerTest, QosIsThatOfTheRecordingInAllItsSpellings) {
  const auto qos = [](const std::string& text) {
    mcap::Channel channel;
    channel.metadata["offered_qos_profiles"] = text;
    return qos_of(channel);
  };
  for (const QosProfile& profile : {qos::sensor, qos::state, qos::command, qos::map, qos::event}) {
    const QosProfile read = qos(qos_metadata(profile));
    EXPECT_EQ(read.reliable, profile.reliable) << profile.name;
    EXPECT_EQ(read.transient_local, profile.transient_local) << profile.name;
    EXPECT_EQ(read.depth, profile.depth) << profile.name;
  }
  // rosbag2 from Iron on, and a list of two publishers of which one is weaker.
  EXPECT_FALSE(qos("- history: keep_last\n  depth: 5\n  reliability: best_effort\n").reliable);
  EXPECT_TRUE(qos("- history: keep_last\n  durability: transient_local\n").transient_local);
  EXPECT_FALSE(qos("- reliability: 1\n  durability: 2\n- reliability: 2\n").reliable);
  EXPECT_TRUE(qos("").reliable);
  EXPECT_FALSE(qos("").transient_local);
  EXPECT_GE(qos("- depth: 0\n").depth, 1);
  EXPECT_LE(qos("- depth: 99999999999\n").depth, 10'000);
}

TEST_F(PlayerTest, TheLastMapFromBeforeTheStartIsPlayedFirst) {
  {
    auto writer = mcap::Writer::open(file_);
    const auto schema = writer->add_schema("test/msg/Blob", "", std::string_view());
    const std::map<std::string, std::string> latched = {
        {"offered_qos_profiles", qos_metadata(qos::map)}};
    const std::uint16_t a = writer->add_channel("a", "cdr", *schema, latched).value();
    const std::uint16_t b = writer->add_channel("b", "cdr", *schema).value();
    for (std::uint8_t i = 0; i < 10; ++i) {
      const Cdr cdr{0, 1, 0, 0, i};
      const std::uint16_t channel = i < 5 && i % 2 == 0 ? a : b;
      ASSERT_TRUE(writer->write(mcap::Message{channel, i, 1000U * i, 1000U * i, cdr}).ok());
    }
  }
  PlayerParams params;
  params.start = 7us;
  std::vector<int> heard;
  for (const Sample& sample : play(*mcap::Reader::open(file_), params)) {
    heard.push_back(sample.data.back());
  }
  EXPECT_THAT(heard, testing::ElementsAre(4, 7, 8, 9));
}

}  // namespace
}  // namespace swiftlet
