// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <fstream>
#include <iterator>

#include "tests/system/recorded.hpp"
#include "tests/system/system_test.hpp"

namespace swiftlet::test {
namespace {

using nlohmann::json;

class RecordedFlight : public SystemTest {
 protected:
  /// A flight over the office of which more than a second is on disk.
  Process fly_for_a_while(const std::string& file) {
    Process flight =
        start({"--log", "warning", "fly", office(), "--record", file, "--report", path("report")});
    const bool under_way = becomes_true(kStartLimit, [&] {
      std::error_code not_there_yet;
      const auto size = std::filesystem::file_size(file, not_there_yet);
      return !not_there_yet && size > 300'000;
    });
    EXPECT_TRUE(under_way) << flight.err();
    return flight;
  }

  std::string bytes(const std::string& file) const {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(RecordedFlight, InterruptedIsClosedAndSound) {
  const std::string file = path("f.mcap");
  Process flight = fly_for_a_while(file);
  expect_end(flight, SIGINT, 1);  // the mission was not flown

  EXPECT_EQ(read_report(folder() / "report")["success"], false);
  EXPECT_EQ(read_report(folder() / "report")["reason"], "interrupted");
  const Finished verified = run({"bag", "verify", file});
  EXPECT_EQ(verified.exit_code, 0) << verified.err;
  const json info = json::parse(run({"bag", "info", "--json", file}).out);
  EXPECT_EQ(info["finished"], true);
  EXPECT_GT(info["duration_s"], 1.0);
  const auto topics = read_topics(file);
  for (const char* topic : {"imu0", "scan", "odometry", "motors", "vehicle/status"}) {
    EXPECT_EQ(topics.count(topic), 1U) << topic;
  }
}

TEST_F(RecordedFlight, KilledIsReadableButForItsEnd) {
  const std::string file = path("f.mcap");
  Process flight = fly_for_a_while(file);
  const auto on_disk = std::filesystem::file_size(file);
  expect_end(flight, SIGKILL, 128 + SIGKILL);
  EXPECT_GE(std::filesystem::file_size(file), on_disk);

  const Finished info = run({"bag", "info", "--json", file});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.err, testing::HasSubstr("not closed"));
  const json read = json::parse(info.out);
  EXPECT_EQ(read["finished"], false);
  EXPECT_GT(read["duration_s"], 1.0);
  EXPECT_GT(read["messages"], 1000);
  EXPECT_GT(read_topics(file).at("imu0").size(), 500U);
}

TEST_F(RecordedFlight, ReplayedGivesTheSameMapEachTime) {
  const std::string file = path("f.mcap");
  ASSERT_EQ(run({"fly", hop(), "--record", file}).exit_code, 0);
  for (const char* map : {"first.pgm", "second.pgm"}) {
    const Finished replayed = run({"replay", file, "--into", "lidar_mapper", "--map", path(map)});
    ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  }
  ASSERT_FALSE(bytes(path("first.pgm")).empty());
  EXPECT_EQ(bytes(path("first.pgm")), bytes(path("second.pgm")));
}

}  // namespace
}  // namespace swiftlet::test
