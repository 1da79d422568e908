// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Recorder and player while time passes, and as programs that only share the network with us.
// Waiting is for something to happen, up to a deadline that only a failure reaches.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <set>

#include "components/bag/player.hpp"
#include "components/bag/recorder.hpp"
#include "tests/components/bag/scripted_traffic.hpp"
#include "tests/components/bag/temporary_folder.hpp"
#include "tests/system/system_test.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr Duration kDeadline = 40s * test::kSlowdown;

const std::vector<ScriptedTopic> kTopics = {{"rt/scan", kScanType, qos::event},
                                            {"rt/imu0", kImuType, qos::event},
                                            {"rt/large", kMapType, qos::map}};

HostOptions live(int domain, bool isolated) {
  HostOptions options;
  options.participant.domain = domain;
  options.participant.isolated = isolated;
  return options;
}

/// Ends the run with 0 as soon as something has happened, and with 1 at the deadline.
struct Until : Component {
  Until(const ComponentContext& context, std::function<bool()> happened) : Component(context) {
    every(10ms, [this, happened](Time) {
      if (happened()) stop(0);
    });
    call_at(now() + kDeadline, [this](Time) { stop(1); });
  }
};

/// Publishes a script as fast as readers allow, once each topic has a reader.
class Speaker : public Component {
 public:
  Speaker(const ComponentContext& context, std::vector<Publication> script)
      : Component(context), script_(std::move(script)) {
    for (const auto& [wire, type, qos] : kTopics) {
      writers_.push_back(advertise_raw(wire, type, qos));
    }
    every(1ms, [this](Time) {
      for (const auto& writer : writers_) {
        if (writer->matched_readers() == 0) return;
      }
      if (next_ == script_.size()) return;
      writers_[script_[next_].topic]->write(script_[next_].cdr);
      ++next_;
    });
  }

 private:
  std::vector<Publication> script_;
  std::size_t next_ = 0;
  std::vector<std::shared_ptr<Writer>> writers_;
};

/// A script whose times do not matter, with one sample that needs many packets.
std::vector<Publication> script_of(unsigned seed, std::size_t count) {
  auto script = random_publications(seed, 2, count, 1ms);
  std::mt19937 random(seed);
  Cdr large = random_cdr(random, 1);
  large.resize(400'000);
  for (std::size_t i = 4; i < large.size(); ++i) large[i] = static_cast<std::uint8_t>(i / 7);
  script[count / 2] = {Time{}, 2, large};
  return script;
}

/// By topic, what was sent in the order of sending.
std::map<std::string, std::vector<Cdr>> by_topic(const std::vector<Publication>& script) {
  std::map<std::string, std::vector<Cdr>> sent;
  for (const Publication& publication : script) {
    sent[kTopics[publication.topic].wire.substr(3)].push_back(publication.cdr);
  }
  return sent;
}

std::map<std::string, std::vector<Cdr>> by_topic(const std::vector<Sample>& samples) {
  std::map<std::string, std::vector<Cdr>> heard;
  for (const Sample& sample : samples) heard[sample.topic].push_back(sample.data);
  return heard;
}

/// DDS pads samples on the network to four bytes: these must be zero, and all else equal.
bool equal_but_for_padding(const std::vector<Cdr>& received, const std::vector<Cdr>& sent) {
  return std::equal(received.begin(), received.end(), sent.begin(), sent.end(),
                    [](Cdr a, const Cdr& b) {
                      if (a.size() < b.size() || a.size() > (b.size() + 3) / 4 * 4) return false;
                      const bool zero = std::all_of(a.begin() + static_cast<long>(b.size()),
                                                    a.end(), [](auto byte) { return byte == 0; });
                      a.resize(b.size());
                      return zero && a == b;
                    });
}

/// What a recording that is still being written has on disk.
std::size_t messages_on_disk(const std::filesystem::path& file) {
  const auto reader = mcap::Reader::open(file);
  return reader.ok() ? reader->statistics().message_count : 0;
}

class LiveBag : public test::SystemTest {
 protected:
  std::filesystem::path file_ = path("f.mcap");
};

TEST_F(LiveBag, WhatIsPublishedIsWhatIsRecorded) {
  const auto script = script_of(1, 800);
  Host host(live(domain(), true));
  host.emplace<Speaker>("speaker", script);
  auto& recorder = host.emplace<Recorder>("recorder", RecorderParams{file_, {}, false});
  host.emplace<Until>("until", [&] { return messages_on_disk(file_) == script.size(); });
  const Time begin = host.executor().now();
  ASSERT_EQ(host.run(), 0) << messages_on_disk(file_) << " messages are on disk";
  const Time end = host.executor().now();
  ASSERT_TRUE(recorder.close().ok());

  const auto samples = mcap::read_samples(*mcap::Reader::open(file_));
  EXPECT_EQ(by_topic(samples), by_topic(script));
  std::map<std::string, std::uint32_t> sequence;
  for (const Sample& sample : samples) {
    EXPECT_EQ(sample.sequence, sequence[sample.topic]++);
    EXPECT_GE(sample.log_time, mcap::to_timestamp(begin));
    EXPECT_LE(sample.log_time, mcap::to_timestamp(end));
  }
}

TEST_F(LiveBag, WhatIsPlayedIsWhatWasRecorded) {
  std::vector<Sample> samples = mcap::random_samples(2, 600, 0);
  for (Sample& sample : samples) sample.data.insert(sample.data.begin(), {0, 1, 0, 0});
  mcap::write_samples(file_, samples, {});
  const auto reader = mcap::Reader::open(file_);
  const std::vector<ScriptedTopic> topics = {{"rt/a", "test::msg::dds_::Blob_", qos::event},
                                             {"rt/b", "test::msg::dds_::Blob_", qos::event},
                                             {"rt/c", "test::msg::dds_::Blob_", qos::event}};
  Host host(live(domain(), true));
  PlayerParams params;
  params.rate = 1e-3;  // 0.3 ms of recording
  params.stop_at_end = false;
  auto& listener = host.emplace<Listener>("listener", topics, samples.size());
  auto& player = host.emplace<Player>("player", *reader, params);
  host.emplace<Until>("until", [] { return false; });
  ASSERT_EQ(host.run(), 0);
  EXPECT_EQ(player.played(), samples.size());
  EXPECT_EQ(by_topic(listener.heard()), by_topic(mcap::by_time(samples)));
}

/// Offers a topic and speaks at once, before anybody can have found it.
struct Latched : Component {
  explicit Latched(const ComponentContext& context) : Component(context) {
    call_at(now() + 250ms, [this](Time) {
      writer_ = advertise_raw("rt/map", kMapType, qos::map);
      writer_->write(Cdr{0, 1, 0, 0, 9});
    });
  }
  std::shared_ptr<Writer> writer_;
};

TEST_F(LiveBag, AMapFromBeforeTheRecorderFoundItIsRecorded) {
  Host host(live(domain(), true));
  host.emplace<Latched>("latched");
  auto& recorder = host.emplace<Recorder>("recorder", RecorderParams{file_, {}, false});
  host.emplace<Until>("until", [&] { return messages_on_disk(file_) == 1; });
  ASSERT_EQ(host.run(), 0);
  ASSERT_TRUE(recorder.close().ok());
  EXPECT_EQ(mcap::read_samples(*mcap::Reader::open(file_))[0].data, (Cdr{0, 1, 0, 0, 9}));
}

/// Begins to listen to the map only when it was played.
struct LateListener : Component {
  LateListener(const ComponentContext& context, std::function<bool()> played) : Component(context) {
    every(10ms, [this, played](Time) {
      if (listening_ || !played()) return;
      listening_ = true;
      subscribe_raw("rt/map", kMapType, qos::map, [this](const Cdr& cdr) {
        EXPECT_EQ(cdr, (Cdr{0, 1, 0, 0, 7}));
        stop(0);
      });
    });
    call_at(now() + kDeadline, [this](Time) { stop(1); });
  }
  bool listening_ = false;
};

TEST_F(LiveBag, AMapThatWasPlayedIsThereForWhoComesLater) {
  {
    auto writer = mcap::Writer::open(file_);
    const auto schema = writer->add_schema("nav_msgs/msg/OccupancyGrid", "", std::string_view());
    const auto channel = writer->add_channel("map", "cdr", *schema,
                                             {{"offered_qos_profiles", qos_metadata(qos::map)}});
    const Cdr cdr{0, 1, 0, 0, 7};
    ASSERT_TRUE(writer->write(mcap::Message{*channel, 0, 1000, 1000, cdr}).ok());
  }
  const auto reader = mcap::Reader::open(file_);
  Host host(live(domain(), true));
  std::atomic<bool> heard_in_time{false};
  struct Prompt : Component {
    Prompt(const ComponentContext& context, std::atomic<bool>& heard) : Component(context) {
      subscribe_raw("rt/map", kMapType, qos::map, [&heard](const Cdr&) { heard = true; });
    }
  };
  PlayerParams params;
  params.stop_at_end = false;
  host.emplace<Prompt>("prompt", heard_in_time);
  host.emplace<LateListener>("late", [&] { return heard_in_time.load(); });
  host.emplace<Player>("player", *reader, params);
  EXPECT_EQ(host.run(), 0);
}

TEST_F(LiveBag, AnotherProcessRecordsWhatIsPublishedHere) {
  const auto script = script_of(3, 500);
  test::Process recorder = start({"bag", "record", "-o", file_});
  Host host(live(domain(), false));
  host.emplace<Speaker>("speaker", script);
  host.emplace<Until>("until", [&] { return messages_on_disk(file_) == script.size(); });
  EXPECT_EQ(host.run(), 0) << messages_on_disk(file_) << " messages are on disk";
  recorder.send(SIGINT);
  const auto outcome = recorder.wait(test::kExitLimit);
  ASSERT_TRUE(outcome) << "the recorder did not end";
  EXPECT_EQ(outcome->exit_code, 0) << outcome->err;
  EXPECT_THAT(outcome->out, HasSubstr("500 messages of 3 topics"));

  const auto reader = mcap::Reader::open(file_);
  ASSERT_TRUE(reader.ok());
  EXPECT_TRUE(reader->finished());
  const auto recorded = by_topic(mcap::read_samples(*reader));
  for (const auto& [topic, sent] : by_topic(script)) {
    EXPECT_TRUE(equal_but_for_padding(recorded.at(topic), sent)) << topic;
  }
}

TEST_F(LiveBag, AnotherProcessPlaysAndAllOfItArrivesHere) {
  const auto script = script_of(4, 400);
  {
    auto writer = mcap::Writer::open(file_);
    std::map<std::size_t, std::uint16_t> channels;
    for (std::size_t i = 0; i < kTopics.size(); ++i) {
      const auto schema = writer->add_schema(ros_type_name(kTopics[i].type), "", {});
      channels[i] = *writer->add_channel(kTopics[i].wire.substr(3), "cdr", *schema,
                                         {{"offered_qos_profiles", qos_metadata(kTopics[i].qos)}});
    }
    for (const Publication& publication : script) {
      const mcap::Timestamp time = mcap::to_timestamp(publication.time);
      ASSERT_TRUE(
          writer->write(mcap::Message{channels[publication.topic], 0, time, time, publication.cdr})
              .ok());
    }
  }
  Host host(live(domain(), false));
  auto& listener = host.emplace<Listener>("listener", kTopics, script.size());
  host.emplace<Until>("until", [] { return false; });
  test::Process player = start({"bag", "play", file_, "--rate", "0.2", "--delay", "3"});
  EXPECT_EQ(host.run(), 0) << listener.heard().size() << " of " << script.size() << " arrived";
  const auto outcome = player.wait(test::kExitLimit);
  ASSERT_TRUE(outcome) << "the player did not end";
  EXPECT_EQ(outcome->exit_code, 0) << outcome->err;
  EXPECT_THAT(outcome->out, HasSubstr("played 400 messages"));
  const auto heard = by_topic(listener.heard());
  for (const auto& [topic, sent] : by_topic(script)) {
    ASSERT_EQ(heard.count(topic), 1U) << topic;
    EXPECT_TRUE(equal_but_for_padding(heard.at(topic), sent)) << topic;
  }
}

TEST_F(LiveBag, AProgramThatCannotBeginSaysWhyAndLeavesNothing) {
  mcap::write_samples(file_, mcap::random_samples(5, 100, 0), {});
  write("text.txt", "hello\n");
  const auto expect = [&](std::vector<std::string> arguments, int exit_code,
                          const std::string& reason) {
    const test::Finished outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(reason));
  };
  expect({"bag", "record", "-o", file_}, 2, "f.mcap");
  expect({"bag", "record", "-o", path("no/x.mcap")}, 2, "no/x.mcap");
  expect({"bag", "play", path("missing.mcap")}, 2, "missing.mcap");
  expect({"bag", "play", path("text.txt")}, 2, "text.txt");
  expect({"bag", "play", file_, "--topics", "bb"}, 2, "did you mean 'b'?");
  expect({"bag", "play", file_, "--start", "99"}, 2, "only 0.000 s long");
  for (const char* number : {"nan", "inf", "-1", "x"}) {
    expect({"bag", "play", file_, "--start", number}, 2, "--start");
    expect({"bag", "play", file_, "--rate", number}, 2, "--rate");
    expect({"bag", "play", file_, "--delay", number}, 2, "--delay");
  }
  std::set<std::string> left;
  for (const auto& entry : std::filesystem::directory_iterator(folder())) {
    left.insert(entry.path().filename());
  }
  EXPECT_THAT(left, testing::ElementsAre("f.mcap", "log", "text.txt"));
}

TEST_F(LiveBag, PlayingADamagedRecordingEndsWithAnError) {
  mcap::WriterParams params;
  params.chunk_size = 4000;
  mcap::write_samples(file_, mcap::random_samples(6, 500, 0), params);
  const auto chunk = mcap::Reader::open(file_)->chunks()[1];
  auto bytes = read_bytes(file_);
  bytes.at(chunk.chunk_start_offset + chunk.chunk_length / 2) ^= 0x40;
  std::ofstream(file_, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
  const test::Finished damaged = run({"bag", "play", file_, "--delay", "0"});
  EXPECT_EQ(damaged.exit_code, 1);
  EXPECT_THAT(damaged.err, HasSubstr("damaged chunks that were left out: 1;"));

  // One that was cut is played as far as it goes, and says so.
  std::filesystem::resize_file(file_, chunk.chunk_start_offset + 100);
  const test::Finished cut = run({"bag", "play", file_, "--delay", "0"});
  EXPECT_EQ(cut.exit_code, 0) << cut.err;
  EXPECT_THAT(cut.err, HasSubstr("not closed"));
}

}  // namespace
}  // namespace swiftlet
