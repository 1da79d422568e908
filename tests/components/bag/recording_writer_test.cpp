// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Recordings in parts: each stands by itself, and together they are what was written.
#include "components/bag/recording_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/bag/mcap/verify.hpp"
#include "components/bag/recording.hpp"
#include "tests/components/bag/mcap_test_files.hpp"
#include "tests/components/bag/temporary_folder.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using mcap::Sample;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr mcap::Timestamp kBegin = 1'000'000'000;
constexpr mcap::Timestamp kMs = 1'000'000;

RecordedTopic topic(const std::string& name, bool latched) {
  return {name, "test/msg/" + name, "ros2idl", "idl of " + name, {{"key", name}}, latched};
}

/// On topics 0 to 2, of which 2 is latched and has two writers; one each millisecond.
std::vector<RecordedSample> samples(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  std::vector<RecordedSample> samples(count);
  std::array<std::uint32_t, 3> sequence{};
  for (std::size_t i = 0; i < count; ++i) {
    RecordedSample& sample = samples[i];
    const auto draw = random() % 50;
    sample.topic = draw == 0 ? 2 : draw % 2;
    sample.sequence = sequence[sample.topic]++;
    sample.log_time = kBegin + i * kMs;
    sample.publish_time = sample.log_time - 5;
    sample.writer[0] = static_cast<std::uint8_t>(random() % 2);
    sample.data.resize(sample.topic == 2 ? 3000 : random() % 200);
    for (auto& byte : sample.data) byte = static_cast<std::uint8_t>(random());
  }
  return samples;
}

std::vector<Sample> read_all(const Recording& recording, const mcap::Filter& filter = {}) {
  std::vector<Sample> all;
  auto cursor = recording.messages(filter);
  for (;;) {
    const auto next = cursor.next();
    if (!next.ok()) {
      ADD_FAILURE() << next.error().reason;
      return all;
    }
    if (!*next) return all;
    const mcap::Message& message = (*next)->message;
    EXPECT_EQ(message.channel_id, (*next)->channel->id);
    all.push_back({(*next)->channel->topic, message.sequence, message.log_time,
                   message.publish_time, message.data.copy()});
  }
}

class RecordingWriterTest : public testing::Test {
 protected:
  RecordingWriterTest() {
    params_.file = folder_ / "flight.mcap";
    params_.start = kBegin;
    params_.run = {{"start_ns", "1000000000"}};
  }

  std::vector<std::filesystem::path> write(const std::vector<RecordedSample>& samples) {
    auto writer = RecordingWriter::open(params_);
    if (!writer.ok()) {
      ADD_FAILURE() << writer.error().reason;
      return {};
    }
    for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(writer->add_topic(topics_[i]).ok());
    for (const RecordedSample& sample : samples) EXPECT_TRUE(writer->write(sample).ok());
    EXPECT_TRUE(writer->close().ok());
    EXPECT_EQ(writer->messages(), samples.size());
    return writer->files();
  }

  std::vector<Sample> expected(const std::vector<RecordedSample>& samples) const {
    std::vector<Sample> all;
    for (const RecordedSample& sample : samples) {
      all.push_back({topics_[sample.topic].name, sample.sequence, sample.log_time,
                     sample.publish_time, sample.data});
    }
    return all;
  }

  const std::array<RecordedTopic, 3> topics_ = {topic("a", false), topic("b", false),
                                                topic("map", true)};
  TemporaryFolder folder_;
  RecordingWriterParams params_;
};

TEST_F(RecordingWriterTest, PartsReadAsOneAreWhatWasWritten) {
  const auto written = samples(1, 3000);
  for (const bool by_size : {true, false}) {
    params_.split_size = by_size ? 40'000 : 0;
    params_.split_duration = by_size ? Duration(0) : Duration(200ms);
    params_.overwrite = true;
    const auto files = write(written);
    ASSERT_GT(files.size(), 4U);
    const auto recording = Recording::open(files);
    ASSERT_TRUE(recording.ok());
    EXPECT_TRUE(read_all(*recording) == expected(written));
    EXPECT_EQ(recording->statistics().message_count, written.size());
    EXPECT_EQ(recording->channels().size(), 3U);
    EXPECT_EQ(recording->schemas().size(), 3U);
    EXPECT_THAT(missing_parts(*recording), IsEmpty());
    EXPECT_TRUE(read_all(Recording::open({folder_.path()}).value()) == expected(written));
  }
}

TEST_F(RecordingWriterTest, PartsAreAsLongAndAsLargeAsAskedFor) {
  params_.split_duration = 250ms;
  for (const auto& file : write(samples(2, 1000))) {
    const auto statistics = mcap::Reader::open(file)->statistics();
    EXPECT_LT(statistics.message_end_time - statistics.message_start_time, 250 * kMs);
  }
  params_.split_duration = Duration(0);
  params_.split_size = 30'000;
  params_.overwrite = true;
  const auto files = write(samples(3, 6000));
  for (std::size_t i = 0; i + 1 < files.size(); ++i) {
    // A part ends at the first chunk beyond: one is half a second of about a hundred bytes a
    // message; what is repeated and the summary come on top.
    EXPECT_GT(std::filesystem::file_size(files[i]), 30'000U);
    EXPECT_LT(std::filesystem::file_size(files[i]), 30'000U + 150'000U);
  }
}

TEST_F(RecordingWriterTest, EachPartStandsByItself) {
  const auto written = samples(4, 3000);
  params_.split_duration = 300ms;
  const auto files = write(written);
  std::map<std::uint8_t, RecordedSample> latched;  // by writer
  std::size_t next = 0;
  for (std::size_t part = 0; part < files.size(); ++part) {
    const auto source = mcap::open_file(files[part]);
    EXPECT_THAT(mcap::verify(*source)->problems, IsEmpty());
    const auto reader = mcap::Reader::open(files[part]);
    EXPECT_EQ(reader->channels().size(), 3U);
    EXPECT_EQ(reader->schemas().at(reader->channels().at(3).schema_id).name, "test/msg/map");
    const auto alone = mcap::read_samples(*reader);
    ASSERT_GT(alone.size(), latched.size());
    // First what a reader that came now would get from DDS, at the time of the part's beginning.
    std::set<mcap::Bytes> first, expected_first;
    for (std::size_t i = 0; i < latched.size(); ++i) {
      EXPECT_EQ(alone[i].topic, "map");
      EXPECT_EQ(alone[i].log_time, written[next].log_time);
      first.insert(alone[i].data);
    }
    for (const auto& [writer, sample] : latched) expected_first.insert(sample.data);
    EXPECT_EQ(first, expected_first) << "part " << part;
    for (std::size_t i = latched.size(); i < alone.size(); ++i, ++next) {
      EXPECT_EQ(alone[i].data, written[next].data);
    }
    for (std::size_t i = 0; i < next; ++i) {
      if (written[i].topic == 2) latched[written[i].writer[0]] = written[i];
    }
    EXPECT_EQ(metadata_named(*reader, kRunRecord)->metadata.at("start_ns"), "1000000000");
  }
  EXPECT_EQ(next, written.size());
}

TEST_F(RecordingWriterTest, TimeRangesOfPartsAreThoseOfTheWhole) {
  const auto written = samples(5, 2000);
  params_.split_duration = 300ms;
  const auto recording = Recording::open(write(written));
  mcap::Filter filter;
  filter.first = kBegin + 250 * kMs;
  filter.last = kBegin + 950 * kMs;
  filter.topics = {"a", "map"};
  std::vector<Sample> wanted;
  for (const Sample& sample : expected(written)) {
    if (sample.topic != "b" && sample.log_time >= filter.first && sample.log_time <= filter.last) {
      wanted.push_back(sample);
    }
  }
  EXPECT_TRUE(read_all(*recording, filter) == wanted);
}

TEST_F(RecordingWriterTest, LossesOfPartsAddUp) {
  params_.split_duration = 100ms;
  auto writer = RecordingWriter::open(params_);
  for (const RecordedTopic& known : topics_) ASSERT_TRUE(writer->add_topic(known).ok());
  LossLedger losses;
  const auto written = samples(6, 500);
  for (std::size_t i = 0; i < written.size(); ++i) {
    ASSERT_TRUE(writer->write(written[i]).ok());
    if (i % 70 == 0) losses["a"].by_dds += 3;
    if (i % 110 == 0) losses["b"].by_recorder += 2;
    if (i % 50 == 0) {
      ASSERT_TRUE(writer->note(losses, written[i].log_time).ok());
    }
  }
  ASSERT_TRUE(writer->note(losses, written.back().log_time).ok());
  ASSERT_TRUE(writer->close().ok());
  EXPECT_EQ(losses_of(*Recording::open(writer->files())), losses);
  const Loss first = total(*losses_of(*mcap::Reader::open(writer->files().front())));
  EXPECT_LT(first.total(), total(losses).total()) << "a part counts what it lacks itself";
}

TEST_F(RecordingWriterTest, AFileSaysThatNothingWasLostAndOthersSayNothing) {
  EXPECT_EQ(losses_of(*mcap::Reader::open(write(samples(7, 10)).front())), LossLedger());
  mcap::write_samples(folder_ / "other.mcap", mcap::random_samples(1, 10, 0), {});
  EXPECT_EQ(losses_of(*mcap::Reader::open(folder_ / "other.mcap")), std::nullopt);
}

TEST_F(RecordingWriterTest, PartsOfAnEarlierRecordingAreKeptUnlessToldOtherwise) {
  params_.split_duration = 100ms;
  const auto before = write(samples(8, 1000));
  const auto refused = RecordingWriter::open(params_);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().reason, HasSubstr("flight_0.mcap"));
  params_.overwrite = true;
  const auto after = write(samples(9, 200));
  ASSERT_LT(after.size(), before.size());
  std::size_t left = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    left += entry.path().extension() == ".mcap" ? 1 : 0;
  }
  EXPECT_EQ(left, after.size()) << "parts of two recordings stand beside each other";
}

TEST_F(RecordingWriterTest, APartThatIsNotThereIsNamed) {
  params_.split_duration = 100ms;
  auto files = write(samples(10, 1000));
  std::filesystem::remove(files[3]);
  std::filesystem::remove(files[4]);
  const auto recording = Recording::open({folder_.path()});
  EXPECT_THAT(missing_parts(*recording), ElementsAre(HasSubstr("parts 3 to 4 are missing")));
}

TEST_F(RecordingWriterTest, APartThatIsDamagedCostsItsOwnMessages) {
  params_.split_duration = 100ms;
  const auto files = write(samples(11, 1000));
  std::filesystem::resize_file(files[2], 3);
  const auto recording = Recording::open({folder_.path()});
  ASSERT_TRUE(recording.ok()) << recording.error().reason;
  EXPECT_THAT(recording->damage().front().reason, HasSubstr(files[2].string()));
  EXPECT_EQ(read_all(*recording).size(), recording->statistics().message_count);
  EXPECT_GT(recording->statistics().message_count, 700U);
}

TEST(Recordings, OfTheSameTimeAreMerged) {
  const TemporaryFolder folder;
  const auto all = mcap::random_samples(12, 600, 5000);
  std::array<std::vector<Sample>, 3> parts;
  std::mt19937 random(1);
  for (const Sample& sample : all) parts[random() % 3].push_back(sample);
  std::vector<std::filesystem::path> files;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    files.push_back(folder / (std::to_string(i) + ".mcap"));
    mcap::WriterParams params;
    params.chunk_size = 1000;
    mcap::write_samples(files.back(), parts[i], params);
  }
  const auto recording = Recording::open(files);
  EXPECT_EQ(recording->channels().size(), 3U);
  std::vector<Sample> merged = read_all(*recording);
  EXPECT_TRUE(std::is_sorted(merged.begin(), merged.end(),
                             [](const auto& a, const auto& b) { return a.log_time < b.log_time; }));
  // Those of the same time are in the order of the files: compare as sets of one moment.
  const auto by_moment = [](std::vector<Sample> samples) {
    std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
      return std::tie(a.log_time, a.sequence) < std::tie(b.log_time, b.sequence);
    });
    return samples;
  };
  EXPECT_TRUE(by_moment(merged) == by_moment(all));
}

TEST(Recordings, OfAFolderWithoutAnyAreRefused) {
  const TemporaryFolder folder;
  const auto none = Recording::open({folder.path()});
  ASSERT_FALSE(none.ok());
  EXPECT_THAT(none.error().reason, HasSubstr("holds no recording"));
}

TEST(Recordings, TopicsOfDifferentTypesStayApart) {
  const TemporaryFolder folder;
  for (const char* type : {"x/msg/A", "x/msg/B"}) {
    auto writer = mcap::Writer::open(folder / (std::string(type).substr(6) + ".mcap"));
    const auto schema = writer->add_schema(type, "", {});
    const auto channel = writer->add_channel("t", "cdr", *schema);
    ASSERT_TRUE(writer->write(mcap::Message{*channel, 0, 5, 5, {}}).ok());
  }
  const auto recording = Recording::open({folder.path()});
  ASSERT_EQ(recording->channels().size(), 2U);
  std::set<std::string> types;
  auto cursor = recording->messages();
  for (auto next = cursor.next(); next.ok() && *next; next = cursor.next()) {
    types.insert((*next)->schema->name);
  }
  EXPECT_THAT(types, ElementsAre("x/msg/A", "x/msg/B"));
}

}  // namespace
}  // namespace swiftlet
