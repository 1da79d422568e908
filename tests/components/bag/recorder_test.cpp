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
#include "components/bag/recording.hpp"
#include "components/bag/recording_records.hpp"
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

TEST_F(RecorderTest, PatternsChooseTopics) {
  const std::vector<ScriptedTopic> topics = {{"rt/camera/left/image", kImuType},
                                             {"rt/camera/info", kImuType},
                                             {"rt/camera_info", kImuType},
                                             {"rt/imu0", kImuType},
                                             {"rt/imu10", kImuType},
                                             {"ros_discovery_info", kImuType},
                                             {"rq/serviceRequest", kImuType}};
  const auto script = random_publications(16, topics.size(), 210, 5ms);
  const auto chosen = [&](TopicPatterns patterns) {
    RecorderParams params;
    params.overwrite = true;
    params.topics = patterns.topics;
    params.regexes = patterns.regexes;
    params.exclude = patterns.exclude;
    return topics_of(record(topics, script, params));
  };
  EXPECT_THAT(chosen({{"camera/*"}, {}, {}}), UnorderedElementsAre("camera/info"));
  EXPECT_THAT(chosen({{"/camera/**"}, {}, {}}),
              UnorderedElementsAre("camera/info", "camera/left/image"));
  EXPECT_THAT(chosen({{"imu?", "nothing*"}, {}, {}}), UnorderedElementsAre("imu0"));
  EXPECT_THAT(missing_, ElementsAre("nothing*"));
  EXPECT_THAT(chosen({{}, {"imu[0-9]+", "camera/.*"}, {}}),
              UnorderedElementsAre("imu0", "imu10", "camera/info", "camera/left/image"));
  EXPECT_THAT(chosen({{"imu0"}, {"imu1."}, {"**0"}}), testing::IsEmpty());
  EXPECT_THAT(chosen({{}, {}, {"camera/**", "imu10"}}), UnorderedElementsAre("camera_info", "imu0"))
      << "what ROS 2 uses beneath its topics is not one";
}

TEST_F(RecorderTest, PatternsThatFitNoNameAreRefused) {
  Host host(lockstep_at());
  for (const char* wrong : {"a b", "a//b", "camera/[ab]", "", "9*", "a/"}) {
    EXPECT_THROW(host.emplace<Recorder>("recorder", RecorderParams{file_, {wrong}, true}),
                 ConfigError)
        << wrong;
  }
  RecorderParams params{file_, {}, true};
  params.regexes = {"imu("};
  EXPECT_THROW(host.emplace<Recorder>("recorder", params), ConfigError);
  EXPECT_FALSE(std::filesystem::exists(file_)) << "a file was made before all was known";
}

TEST_F(RecorderTest, InLockstepTheSameRunGivesTheSameBytes) {
  const auto script = random_publications(11, kTopics.size(), 900, 7ms);
  RecorderParams params;
  params.overwrite = true;
  params.run = {{"scenario", "test"}};
  std::vector<mcap::Bytes> files;
  for (int i = 0; i < 3; ++i) {
    record(kTopics, script, params);
    files.push_back(read_bytes(file_));
  }
  EXPECT_TRUE(files[0] == files[1] && files[1] == files[2]);
}

TEST_F(RecorderTest, TheFileSaysWhichRunItIs) {
  RecorderParams params;
  params.run = {{"scenario", "test"}, {"lockstep", "a lie"}};
  const mcap::Reader reader =
      record({{"rt/uav1/scan", kScanType}}, random_publications(12, 1, 30, 5ms), params, "uav1");
  const auto run = metadata_named(reader, kRunRecord);
  ASSERT_TRUE(run);
  EXPECT_EQ(run->metadata.at("scenario"), "test");
  EXPECT_EQ(run->metadata.at("lockstep"), "true");
  EXPECT_EQ(run->metadata.at("vehicle"), "uav1");
  EXPECT_EQ(run->metadata.at("domain"), "76");
  EXPECT_EQ(run->metadata.at("start_ns"), "0");
  EXPECT_FALSE(run->metadata.at("version").empty());
  EXPECT_EQ(losses_of(reader), LossLedger());
}

TEST_F(RecorderTest, PartsOfALockstepRunAreWhatWasPublished) {
  const auto script = random_publications(13, kTopics.size(), 900, 7ms);
  RecorderParams params;
  params.file = folder_ / "parts" / "f.mcap";
  std::filesystem::create_directories(folder_ / "parts");
  params.split_duration = 500ms;
  Host host(lockstep_at());
  host.emplace<Script>("script", kTopics, script);
  auto& recorder = host.emplace<Recorder>("recorder", params);
  ASSERT_EQ(host.run(), 0);
  ASSERT_TRUE(recorder.close().ok());
  ASSERT_GT(recorder.files().size(), 3U);
  const auto recording = Recording::open({folder_ / "parts"});
  std::vector<Sample> samples;
  auto cursor = recording->messages();
  for (auto next = cursor.next(); next.ok() && *next; next = cursor.next()) {
    samples.push_back({(*next)->channel->topic, (*next)->message.sequence,
                       (*next)->message.log_time, (*next)->message.publish_time,
                       (*next)->message.data.copy()});
  }
  EXPECT_TRUE(samples == expected_samples(kTopics, script));
}

/// Asks the recorder to save its window at some times.
struct Saver : Component {
  Saver(const ComponentContext& context, Recorder*& recorder, const std::vector<Duration>& times)
      : Component(context) {
    for (const Duration time : times) {
      call_at(Time(time), [&recorder](Time) { recorder->save(); });
    }
  }
};

TEST_F(RecorderTest, AWindowIsSavedWhenAskedWithTheMapFromBefore) {
  auto script = random_publications(14, 2, 900, 20ms);  // scan and imu0 over 6 s
  script.insert(script.begin(), {Time(1ms), 2, Cdr{0, 1, 0, 0, 42}});
  Recorder* recorder = nullptr;
  RecorderParams params;
  params.file = folder_ / "last.mcap";
  params.window = 1s;
  Host host(lockstep_at());
  host.emplace<Script>("script", kTopics, script);
  host.emplace<Saver>("saver", recorder, std::vector<Duration>{3005ms, 5005ms});
  recorder = &host.emplace<Recorder>("recorder", params);
  ASSERT_EQ(host.run(), 0);
  ASSERT_TRUE(recorder->close().ok());
  ASSERT_EQ(recorder->files().size(), 2U);
  EXPECT_FALSE(std::filesystem::exists(params.file)) << "only what is asked for is written";
  // It is saved at the next tenth of a second.
  EXPECT_EQ(recorder->files()[0].filename(), "last_19700101T000003.100Z.mcap");
  for (std::size_t i = 0; i < 2; ++i) {
    const mcap::Timestamp end = mcap::to_timestamp(Time(i == 0 ? 3100ms : 5100ms));
    const auto source = mcap::open_file(recorder->files()[i]);
    EXPECT_THAT(mcap::verify(*source)->problems, testing::IsEmpty());
    const auto samples = mcap::read_samples(*mcap::Reader::open(recorder->files()[i]));
    std::vector<Sample> expected;
    for (const Sample& sample : expected_samples(kTopics, script)) {
      if (sample.log_time >= end - 1'000'000'000 && sample.log_time < end) {
        expected.push_back(sample);
      }
    }
    ASSERT_EQ(samples.size(), expected.size() + 1);
    EXPECT_EQ(samples[0].topic, "map");
    EXPECT_EQ(samples[0].data, (Cdr{0, 1, 0, 0, 42}));
    EXPECT_EQ(samples[0].log_time, expected[0].log_time);
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), samples.begin() + 1));
  }
}

TEST_F(RecorderTest, AWindowThatCannotBeSavedIsAnErrorAndTheNextOneIsSaved) {
  Recorder* recorder = nullptr;
  RecorderParams params;
  params.file = folder_ / "last.mcap";
  params.window = 1s;
  std::ofstream(folder_ / "last_19700101T000000.200Z.mcap") << "in the way";
  Host host(lockstep_at());
  host.emplace<Script>("script", kTopics, random_publications(15, 2, 300, 20ms));
  host.emplace<Saver>("saver", recorder, std::vector<Duration>{150ms, 1005ms});
  recorder = &host.emplace<Recorder>("recorder", params);
  ASSERT_EQ(host.run(), 0);
  const Status closed = recorder->close();
  ASSERT_FALSE(closed.ok());
  EXPECT_THAT(closed.error().reason, HasSubstr("last_19700101T000000.200Z.mcap"));
  EXPECT_EQ(recorder->files().size(), 1U);
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
