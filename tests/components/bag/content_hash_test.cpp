// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/content_hash.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "tests/components/bag/mcap_test_files.hpp"
#include "tests/components/bag/temporary_folder.hpp"

namespace swiftlet::mcap {
namespace {

class ContentHash : public testing::Test {
 protected:
  std::string hash(const std::vector<Sample>& samples, std::uint64_t chunk_size = 4000) {
    WriterParams params;
    params.chunk_size = chunk_size;
    write_samples(file_, samples, params);
    return content_hash(file_).value();
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "f.mcap";
};

TEST_F(ContentHash, DoesNotDependOnHowTheFileIsCut) {
  const auto samples = random_samples(11, 300, 20'000);
  EXPECT_EQ(hash(samples, 500), hash(samples, 1 << 20));
  EXPECT_EQ(hash(samples), hash(by_time(samples)));
}

TEST_F(ContentHash, ChangesWithEverythingThatARunDoes) {
  const auto samples = random_samples(12, 100, 0);
  const std::string before = hash(samples);
  const auto changed = [&](const auto& change) {
    auto other = samples;
    change(other);
    return hash(other);
  };
  EXPECT_EQ(changed([](auto&) {}), before);
  const std::vector<std::string> hashes = {
      before,
      changed([](auto& s) { s[40].data.back() ^= 1; }),
      changed([](auto& s) { s[40].data.push_back(0); }),
      changed([](auto& s) { s[40].log_time += 1; }),
      changed([](auto& s) { s[40].topic = s[40].topic == "a" ? "b" : "a"; }),
      changed([](auto& s) { s.erase(s.begin() + 40); }),
      changed([](auto& s) { s.push_back(s.back()); }),
      changed([](auto& s) {  // two messages of one time change places
        std::swap(s[40].data, s[41].data);
        std::swap(s[40].topic, s[41].topic);
      })};
  EXPECT_EQ(std::set<std::string>(hashes.begin(), hashes.end()).size(), hashes.size());
  EXPECT_THAT(hashes, testing::Each(testing::MatchesRegex("[0-9a-f]{16}")));
}

TEST_F(ContentHash, KnowsWhereOneMessageEndsAndTheNextBegins) {
  const auto hash_of = [&](const Bytes& first, const std::string& second_topic) {
    WriterParams params;
    params.overwrite = true;
    auto writer = Writer::open(file_, params);
    const std::uint16_t x = writer->add_channel("x", "cdr", 0).value();
    const std::uint16_t y = writer->add_channel(second_topic, "cdr", 0).value();
    EXPECT_TRUE(writer->write(Message{x, 0, 1000, 1000, first}).ok());
    EXPECT_TRUE(writer->write(Message{y, 0, 1000, 1000, Bytes{7}}).ok());
    EXPECT_TRUE(writer->close().ok());
    return content_hash(file_).value();
  };
  EXPECT_NE(hash_of({0, 1, 0, 0}, "ab"), hash_of({0, 1, 0, 0, 'a'}, "b"));
}

TEST_F(ContentHash, OfADamagedOrMissingFileIsAnError) {
  EXPECT_FALSE(content_hash(folder_ / "missing.mcap").ok());
  hash(random_samples(13, 300, 0));
  const auto chunk = Reader::open(file_)->chunks()[1];
  auto bytes = read_bytes(file_);
  bytes.at(chunk.chunk_start_offset + chunk.chunk_length / 2) ^= 0x40;
  std::ofstream(file_, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
  const auto damaged = content_hash(file_);
  ASSERT_FALSE(damaged.ok());
  EXPECT_THAT(damaged.error().reason, testing::HasSubstr("f.mcap: byte "));
}

}  // namespace
}  // namespace swiftlet::mcap
