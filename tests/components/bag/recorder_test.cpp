// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The recorder in lockstep on real Fast DDS.
#include "components/bag/recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "components/bag/mcap/verify.hpp"
#include "tests/components/bag/scripted_traffic.hpp"
#include "tests/components/bag/temporary_folder.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

const std::vector<ScriptedTopic> kTopics = {{"rt/scan", kScanType, qos::sensor},
                                            {"rt/uav1/imu0", kImuType, qos::command},
                                            {"rt/map", kMapType, qos::map}};

std::vector<std::string> topics_of(const mcap::Reader& reader) {
  std::vector<std::string> topics;
  for (const auto& [id, channel] : reader.channels()) topics.push_back(channel.topic);
  return topics;
}

const mcap::Channel& channel_of(const mcap::Reader& reader, const std::string& topic) {
  for (const auto& [id, channel] : reader.channels()) {
    if (channel.topic == topic) return channel;
  }
  throw std::runtime_error("no channel " + topic);
}

class RecorderTest : public testing::Test {
 protected:
  /// Records a script; the recorder starts before or after the one who publishes.
  mcap::Reader record(const std::vector<ScriptedTopic>& topics,
                      const std::vector<Publication>& script, RecorderParams params = {},
                      const std::string& vehicle = "") {
    params.file = file_;
    HostOptions options = lockstep_at();
    options.vehicle = vehicle;
    Host host(options);
    host.emplace<Script>("script", topics, script);
    auto& recorder = host.emplace<Recorder>("recorder", params);
    EXPECT_EQ(host.run(), 0);
    missing_ = recorder.missing();
    const Status closed = recorder.close();
    EXPECT_TRUE(closed.ok()) << closed.error().reason;
    const auto source = mcap::open_file(file_);
    EXPECT_THAT(mcap::verify(*source)->problems, testing::IsEmpty());
    return mcap::Reader::open(file_).value();
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "f.mcap";
  std::vector<std::string> missing_;
};

TEST_F(RecorderTest, WhatIsPublishedIsWhatIsRecorded) {
  const auto script = random_publications(1, kTopics.size(), 900, 7ms);
  const mcap::Reader reader = record(kTopics, script);
  EXPECT_EQ(mcap::read_samples(reader), expected_samples(kTopics, script));
  EXPECT_THAT(topics_of(reader), UnorderedElementsAre("scan", "uav1/imu0", "map"));
  EXPECT_EQ(reader.header().profile, "ros2");
  EXPECT_GT(reader.chunks().size(), 1U) << "one a second, so that a crash costs no more";
}

TEST_F(RecorderTest, LargeSamplesAreRecordedWhole) {
  std::mt19937 random(2);
  Cdr large = random_cdr(random, 1);
  large.resize(5'000'003, 0x5A);
  const std::vector<Publication> script = {{Time(10ms), 2, large}, {Time(20ms), 2, large}};
  EXPECT_EQ(mcap::read_samples(record(kTopics, script)), expected_samples(kTopics, script));
}

TEST_F(RecorderTest, BurstsAreRecordedWithoutLoss) {
  // More samples in one callback than the topic's own readers would keep.
  std::mt19937 random(3);
  std::vector<Publication> script(40);
  for (Publication& publication : script) publication = {Time(5ms), 1, random_cdr(random, 50)};
  EXPECT_EQ(mcap::read_samples(record(kTopics, script)), expected_samples(kTopics, script));
}

TEST_F(RecorderTest, KnownTypesCarryTheirIdlAndUnknownOnesTheirName) {
  const std::vector<ScriptedTopic> topics = {{"rt/scan", kScanType, qos::sensor},
                                             {"rt/odd", "vendor_msgs::msg::dds_::Odd_"},
                                             {"rt/plain", "Plain"}};
  const auto script = random_publications(4, topics.size(), 60, 5ms);
  const mcap::Reader reader = record(topics, script);
  EXPECT_EQ(mcap::read_samples(reader), expected_samples(topics, script));
  const auto schema = [&](const std::string& topic) {
    return reader.schemas().at(channel_of(reader, topic).schema_id);
  };
  EXPECT_EQ(schema("scan").name, "sensor_msgs/msg/LaserScan");
  EXPECT_EQ(schema("scan").encoding, "ros2idl");
  EXPECT_EQ(schema("odd").name, "vendor_msgs/msg/Odd");
  EXPECT_EQ(schema("odd").encoding, "");
  EXPECT_TRUE(schema("odd").data.empty());
  EXPECT_EQ(schema("plain").name, "Plain");
}

TEST_F(RecorderTest, TheQosOfTheWriterIsNoted) {
  const mcap::Reader reader = record(kTopics, random_publications(5, kTopics.size(), 30, 5ms));
  const auto noted = [&](const std::string& topic) {
    return channel_of(reader, topic).metadata.at("offered_qos_profiles");
  };
  EXPECT_THAT(noted("scan"), HasSubstr("reliability: 2\n  durability: 2"));
  EXPECT_THAT(noted("uav1/imu0"), HasSubstr("reliability: 1\n  durability: 2"));
  EXPECT_THAT(noted("map"), HasSubstr("depth: 1\n  reliability: 1\n  durability: 1"));
}

TEST_F(RecorderTest, OnlyTheTopicsThatAreAskedForAreRecordedAndMissingOnesAreNamed) {
  const auto script = random_publications(6, kTopics.size(), 90, 5ms);
  RecorderParams params;
  params.topics = {"/scan", "uav1/imu0", "nonsense"};
  const mcap::Reader reader = record(kTopics, script, params);
  EXPECT_THAT(topics_of(reader), UnorderedElementsAre("scan", "uav1/imu0"));
  EXPECT_THAT(missing_, ElementsAre("nonsense"));
  std::vector<Sample> expected;
  for (const Sample& sample : expected_samples(kTopics, script)) {
    if (sample.topic != "map") expected.push_back(sample);
  }
  EXPECT_EQ(mcap::read_samples(reader), expected);
}

TEST_F(RecorderTest, OfAVehicleItsOwnTopicsAreRecordedByTheirOwnNames) {
  const std::vector<ScriptedTopic> topics = {
      {"rt/uav1/imu0", kImuType}, {"rt/uav10/imu0", kImuType}, {"rt/imu0", kImuType}};
  const auto script = random_publications(7, topics.size(), 90, 5ms);
  const mcap::Reader reader = record(topics, script, {}, "uav1");
  EXPECT_THAT(topics_of(reader), ElementsAre("imu0"));
  std::vector<Cdr> expected;
  for (const Publication& publication : script) {
    if (publication.topic == 0) expected.push_back(publication.cdr);
  }
  std::vector<Cdr> recorded;
  for (const Sample& sample : mcap::read_samples(reader)) recorded.push_back(sample.data);
  EXPECT_EQ(recorded, expected);
}

/// Speaks on a topic that it offers only from 1.234 s on: at once, and a second later.
struct LateSpeaker : Component {
  explicit LateSpeaker(const ComponentContext& context) : Component(context) {
    call_at(Time(1234ms), [this](Time now) {
      writer_ = advertise_raw("rt/late", kMapType, qos::state);
      writer_->write(Cdr{0, 1, 0, 0, 1});
      call_at(now + 1s, [this](Time) { writer_->write(Cdr{0, 1, 0, 0, 2}); });
      call_at(now + 2s, [this](Time) { stop(0); });
    });
  }
  std::shared_ptr<Writer> writer_;
};

TEST_F(RecorderTest, TopicsThatAppearLaterAreRecordedFromThenOn) {
  Host host(lockstep_at());
  host.emplace<LateSpeaker>("late");
  auto& recorder = host.emplace<Recorder>("recorder", RecorderParams{file_, {}, true});
  ASSERT_EQ(host.run(), 0);
  ASSERT_TRUE(recorder.close().ok());
  const auto samples = mcap::read_samples(*mcap::Reader::open(file_));
  ASSERT_EQ(samples.size(), 1U) << "what was said before the topic was found is over";
  EXPECT_EQ(samples[0].topic, "late");
  EXPECT_EQ(samples[0].data, (Cdr{0, 1, 0, 0, 2}));
  EXPECT_EQ(samples[0].log_time, mcap::to_timestamp(Time(2234ms)));
}

TEST_F(RecorderTest, WritersOfOneTopicWithDifferentQosAreAllRecorded) {
  // Whichever of the two the recorder meets first.
  for (const bool reliable_first : {false, true}) {
    std::vector<ScriptedTopic> topics = {{"rt/imu0", kImuType, qos::command},
                                         {"rt/imu0", kImuType, qos::sensor}};
    if (!reliable_first) std::swap(topics[0], topics[1]);
    const auto script = random_publications(8, topics.size(), 60, 5ms);
    RecorderParams params;
    params.overwrite = true;
    EXPECT_EQ(mcap::read_samples(record(topics, script, params)).size(), script.size());
  }
}

TEST_F(RecorderTest, AFileThatExistsIsKeptUnlessToldOtherwise) {
  std::ofstream(file_) << "a flight that cannot be flown again";
  const auto before = read_bytes(file_);
  Host host(lockstep_at());
  try {
    host.emplace<Recorder>("recorder", RecorderParams{file_, {}, false});
    FAIL() << "the file was replaced";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("f.mcap"));
  }
  EXPECT_EQ(read_bytes(file_), before);
  host.emplace<Recorder>("recorder", RecorderParams{file_, {}, true});
  EXPECT_NE(read_bytes(file_), before);
}

/// In a process of its own, whose files may grow to 200 kB. What it says goes to a file.
[[noreturn]] void record_onto_a_full_disk(const std::filesystem::path& file,
                                          const std::filesystem::path& errors) {
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{200'000, 200'000};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  if (std::freopen(errors.c_str(), "w", stderr) == nullptr) ::_exit(98);
  Host host(lockstep_at());
  host.emplace<Script>("script", kTopics, random_publications(9, kTopics.size(), 3000, 10ms));
  auto& recorder = host.emplace<Recorder>("recorder", RecorderParams{file, {}, false});
  const int exit_code = host.run();
  if (host.executor().now() > Time(5s)) ::_exit(97);  // long before the end of the script
  if (recorder.close().ok()) ::_exit(96);
  std::fflush(stderr);
  ::_exit(exit_code);
}

TEST_F(RecorderTest, AFullDiskEndsTheRunWithAnErrorAndWhatIsOnItIsReadable) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) record_onto_a_full_disk(file_, folder_ / "errors");
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
  const auto errors = read_bytes(folder_ / "errors");
  EXPECT_THAT(std::string(errors.begin(), errors.end()),
              testing::AllOf(HasSubstr("recording stopped"), HasSubstr("f.mcap")));
  const auto reader = mcap::Reader::open(file_);
  ASSERT_TRUE(reader.ok()) << reader.error().reason;
  const auto expected =
      expected_samples(kTopics, random_publications(9, kTopics.size(), 3000, 10ms));
  const auto samples = mcap::read_samples(*reader);
  ASSERT_GT(samples.size(), 500U);
  EXPECT_TRUE(std::equal(samples.begin(), samples.end(), expected.begin()));
}

}  // namespace
}  // namespace swiftlet
