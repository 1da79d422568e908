// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <random>
#include <sstream>

#include "components/bag/carmen/carmen_log.hpp"
#include "components/bag/carmen/line_fields.hpp"
#include "tests/components/bag/temporary_folder.hpp"
#include "tests/data_folder.hpp"

namespace swiftlet::carmen {
namespace {

using testing::HasSubstr;
constexpr double kPi = 3.14159265358979323846;

Result<Log> parse(const std::string& text, const Params& params = {}) {
  std::istringstream stream(text);
  return parse_log(stream, "test.log", params);
}

std::string flaser(std::size_t beams, const std::string& rest) {
  std::string line = "FLASER " + std::to_string(beams);
  for (std::size_t i = 0; i < beams; ++i) line += " 1.5";
  return line + " " + rest + "\n";
}

TEST(CarmenLog, ReadsAScanFieldByField) {
  const auto log = parse("FLASER 4 1 2.5 81.83 0 1.0 2.0 0.5 1.0 2.0 0.5 12.25 host 3.5\n");
  ASSERT_TRUE(log.ok()) << log.error().reason;
  ASSERT_EQ(log->scans.size(), 1U);
  const Scan& scan = log->scans[0];
  ASSERT_EQ(scan.ranges.size(), 4U);
  EXPECT_FLOAT_EQ(scan.ranges[0], 1.0F);
  EXPECT_FLOAT_EQ(scan.ranges[1], 2.5F);
  EXPECT_TRUE(std::isinf(scan.ranges[2]) && scan.ranges[2] > 0);
  EXPECT_EQ(scan.ranges[3], 0.0F);
  EXPECT_EQ(scan.time, Time(std::chrono::milliseconds(12250)));  // not the logger's 3.5 s
  EXPECT_EQ(scan.laser_pose.x, 1.0);
  EXPECT_EQ(scan.laser_pose.theta, 0.5);
}

TEST(CarmenLog, BeamsOfAHalfCircle) {
  const auto angles = [](std::size_t beams) {
    const auto log = parse(flaser(beams, "0 0 0 0 0 0 1 h 1"));
    EXPECT_TRUE(log.ok());
    const Scan& scan = log->scans[0];
    return std::make_pair(
        scan.angle_min, scan.angle_min + (static_cast<double>(beams) - 1.0) * scan.angle_increment);
  };
  EXPECT_NEAR(angles(180).second, 89.0 * kPi / 180.0, 1e-12);
  EXPECT_NEAR(angles(181).second, 90.0 * kPi / 180.0, 1e-12);
  EXPECT_NEAR(angles(360).second, 89.5 * kPi / 180.0, 1e-12);
  EXPECT_NEAR(angles(361).second, 90.0 * kPi / 180.0, 1e-12);
  for (const std::size_t beams : {1U, 2U, 180U, 181U}) EXPECT_EQ(angles(beams).first, -kPi / 2);
}

TEST(CarmenLog, TheMaximumRangeIsTheSmallestThatAnybodyNames) {
  const std::string line = "FLASER 3 9.9 10 49.9 0 0 0 0 0 0 1 h 1\n";
  const auto returns = [](const Result<Log>& log) {
    std::size_t count = 0;
    for (const float range : log->scans[0].ranges) count += std::isfinite(range) ? 1U : 0U;
    return count;
  };
  EXPECT_EQ(returns(parse(line)), 3U);
  EXPECT_EQ(returns(parse(line, Params{10.0})), 1U);
  EXPECT_EQ(returns(parse("PARAM robot_front_laser_max 10.0 nohost 0\n" + line)), 1U);
}

TEST(CarmenLog, ReadsRobotLaserWithRemissionsAndItsOwnAngles) {
  const auto log = parse(
      "ROBOTLASER1 0 -1.5 3.0 0.75 20 0.01 0 5 1 2 3 25 5 5 10 20 30 40 50 "
      "7 8 0.1 6.5 8 0.1 0.4 0.2 0 0 0 5.5 host 0.1\n"
      "RAWLASER1 0 -1.5 3.0 0.75 20 0.01 0 2 1 2 0 6.5 host 0.2\n");
  ASSERT_TRUE(log.ok()) << log.error().reason;
  ASSERT_EQ(log->scans.size(), 2U);
  const Scan& scan = log->scans[0];
  EXPECT_EQ(scan.angle_min, -1.5);
  EXPECT_EQ(scan.angle_increment, 0.75);
  EXPECT_EQ(scan.max_range, 20.0);
  EXPECT_TRUE(std::isinf(scan.ranges[3]));
  EXPECT_THAT(scan.intensities, testing::ElementsAre(10, 20, 30, 40, 50));
  EXPECT_EQ(scan.laser_pose.x, 7.0);
  EXPECT_EQ(scan.robot_pose.x, 6.5);
  EXPECT_EQ(scan.time, Time(std::chrono::milliseconds(5500)));
  EXPECT_FALSE(log->scans[1].has_pose);
}

TEST(CarmenLog, AFixedLaserIsNoCorrectionAMovingOneIs) {
  // The laser sits 0.2 m in front of the robot, which turns and drives.
  const std::string mounted =
      "FLASER 1 1 0.2 0 0 0 0 0 1 h 1\n"
      "FLASER 1 1 3 1.2 1.5707963 3 1 1.5707963 2 h 2\n";
  const auto raw = parse(mounted);
  ASSERT_TRUE(raw.ok());
  EXPECT_FALSE(raw->corrected);
  EXPECT_NEAR(raw->laser_on_robot.x, 0.2, 1e-9);
  const Pose laser = compose(raw->scans[1].robot_pose, raw->laser_on_robot);
  EXPECT_NEAR(laser.x, 3.0, 1e-6);
  EXPECT_NEAR(laser.y, 1.2, 1e-6);
  EXPECT_TRUE(parse(mounted + "FLASER 1 1 5.3 0 0 5 0 0 3 h 3\n")->corrected);
  EXPECT_TRUE(parse(mounted + "NEFF 12.5\n")->corrected);
}

TEST(CarmenLog, OrdersByTimeAndKeepsTheOrderOfLinesOfOneTime) {
  const auto log = parse(
      "ODOM 1 0 0 0 0 0 5 h 5\nODOM 2 0 0 0 0 0 4 h 4\nODOM 3 0 0 0 0 0 5 h 5\n"
      "ODOM 4 0 0 0 0 0 0 h 0\nODOM 5 0 0 0 0 0 6 h 6\n");
  ASSERT_TRUE(log.ok());
  std::vector<double> order;
  for (const Odometry& odometry : log->odometry) order.push_back(odometry.pose.x);
  // Line 4 has no time: it gets that of the line before it.
  EXPECT_THAT(order, testing::ElementsAre(2, 1, 3, 4, 5));
}

TEST(CarmenLog, TimesAreExactToTheNanosecond) {
  EXPECT_EQ(LineFields("976052890.244111").time("t").time_since_epoch().count(),
            976052890244111000);
  EXPECT_EQ(LineFields("976052890.123456789").time("t").time_since_epoch().count(),
            976052890123456789);
  EXPECT_EQ(LineFields("7").time("t").time_since_epoch().count(), 7000000000);
  EXPECT_EQ(LineFields("2.5e-05").time("t").time_since_epoch().count(), 25000);
  for (const char* bad : {"-1", "nan", "inf", "1e300", "9300000000", "1.2.3", "x"}) {
    LineFields fields(bad);
    (void)fields.time("t");
    EXPECT_FALSE(fields.ok()) << bad;
  }
}

TEST(CarmenLog, SkipsAndCountsWhatItDoesNotUse) {
  const auto log = parse("# hello\n\n   \nTRUEPOS 1 2 3\nSYNC a\nTRUEPOS x\r\nPARAM a b h 0\n");
  ASSERT_TRUE(log.ok());
  EXPECT_EQ(log->skipped.at("#"), 1U);
  EXPECT_EQ(log->skipped.at("TRUEPOS"), 2U);
  EXPECT_EQ(log->skipped.at("SYNC"), 1U);
  EXPECT_EQ(log->parameters.at("a"), "b");
  EXPECT_EQ(log->lines, 7U);
}

TEST(CarmenLog, BadLinesAreNamedWithTheirFieldAndARemedy) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"FLASER", "field 2 (number of ranges) is missing"},
      {"FLASER 3 1 2", "field 5 (range) is missing"},
      {"FLASER x", "field 2 (number of ranges, \"x\") is no whole number"},
      {"FLASER -3 1 1 1", "no whole number"},
      {"FLASER 99999999999 1", "no whole number"},
      {"FLASER 2 1 nan 0 0 0 0 0 0 1 h 1", "field 4 (range, \"nan\") is no finite number"},
      {"FLASER 2 1 1 0 0 0 0 1e999 0 1 h 1", "no finite number"},
      {"FLASER 2 1 1 0 0 0 0 0 0 1 h", "field 13 (logger_time) is missing"},
      {"FLASER 2 1 1 0 0 0 0 0 0 -1 h 1", "no time in seconds"},
      {"ODOM 1 2", "field 4 (theta) is missing"},
      {"ODOM 1 2 3 4 5 6 7,5 h 7", "no time in seconds"},
      {"ROBOTLASER1 0 0 0 0 0 0 0 1 1 1", "(remission) is missing"},
      {"PARAM", "field 2 (name) is missing"},
  };
  for (const auto& [line, problem] : cases) {
    const auto log = parse("# one\n" + line + "\n");
    ASSERT_FALSE(log.ok()) << line;
    EXPECT_THAT(log.error().reason, HasSubstr("test.log: line 2: "));
    EXPECT_THAT(log.error().reason, HasSubstr(problem));
    EXPECT_THAT(log.error().reason, HasSubstr("correct or remove the line"));
  }
}

TEST(CarmenLog, NoNanComesOutOfRandomChanges) {
  const std::string text =
      "PARAM robot_front_laser_max 60 h 0\n" + flaser(6, "1 2 3 1 2 3 100.5 h 1") +
      "ODOM 1 2 3 0.1 0.2 0 101 h 1\n" + flaser(6, "2 3 4 2 3 4 102.5 h 1") +
      "ROBOTLASER1 0 -1.5 3.0 0.75 20 0.01 0 2 1 2 1 9 7 8 0.1 6 8 0.1 0 0 0 0 0 5.5 h 0.1\n";
  const std::string alphabet = "0123456789.-+einfax# \n";
  std::mt19937 random(7);
  int accepted = 0;
  for (int i = 0; i < 5000; ++i) {
    std::string mutant = text;
    for (int flips = 0; flips < 3; ++flips) {
      mutant[random() % mutant.size()] = alphabet[random() % alphabet.size()];
    }
    const auto log = parse(mutant);
    if (!log.ok()) continue;
    ++accepted;
    for (const Scan& scan : log->scans) {
      for (const float range : scan.ranges) {
        ASSERT_FALSE(std::isnan(range));
        ASSERT_GE(range, 0.0F);
      }
      const Pose laser = compose(scan.robot_pose, log->laser_on_robot);
      ASSERT_TRUE(std::isfinite(laser.x + laser.y + laser.theta));
      ASSERT_TRUE(std::isfinite(scan.angle_min + scan.angle_increment + scan.max_range));
    }
  }
  EXPECT_GT(accepted, 500);
  EXPECT_LT(accepted, 4500);
}

void write_gzip(const std::filesystem::path& path, const std::string& text) {
  gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
}

TEST(CarmenLog, ReadsGzipAndPlainFilesAlike) {
  const TemporaryFolder folder;
  std::string text;
  for (int i = 0; i < 2000; ++i) text += flaser(20, "0 0 0 0 0 0 " + std::to_string(i) + " h 1");
  write_gzip(folder / "a.log.gz", text);
  std::ofstream(folder / "a.log") << text;
  const auto packed = read_log(folder / "a.log.gz");
  const auto plain = read_log(folder / "a.log");
  ASSERT_TRUE(packed.ok()) << packed.error().reason;
  ASSERT_TRUE(plain.ok());
  EXPECT_EQ(packed->scans.size(), 2000U);
  EXPECT_EQ(plain->scans.size(), 2000U);
}

TEST(CarmenLog, FilesThatCannotBeUsedAreNamed) {
  const TemporaryFolder folder;
  EXPECT_THAT(read_log(folder / "none.log").error().reason,
              HasSubstr("none.log: cannot be opened"));
  EXPECT_THAT(read_log(folder.path()).error().reason, HasSubstr("is a folder"));
  std::ofstream(folder / "text.log") << "this is\nno log\n";
  EXPECT_THAT(read_log(folder / "text.log").error().reason, HasSubstr("text.log: line 2"));

  std::mt19937 random(1);
  std::string text;
  for (int i = 0; i < 3000; ++i) text += flaser(1, std::to_string(random()) + " 0 0 0 0 0 1 h 1");
  write_gzip(folder / "cut.log.gz", text);
  std::filesystem::resize_file(folder / "cut.log.gz",
                               std::filesystem::file_size(folder / "cut.log.gz") / 2);
  const auto cut = read_log(folder / "cut.log.gz");
  ASSERT_FALSE(cut.ok());
  EXPECT_THAT(cut.error().reason, HasSubstr("damaged or cut"));
}

TEST(CarmenRealLogs, AreReadWhole) {
  const auto folder = data_folder() / "lidar2d";
  SWIFTLET_SKIP_WITHOUT(folder);
  const auto raw = read_log(folder / "intel_raw.log.gz");
  ASSERT_TRUE(raw.ok()) << raw.error().reason;
  EXPECT_EQ(raw->scans.size(), 910U);
  EXPECT_EQ(raw->odometry.size(), 12136U);
  EXPECT_FALSE(raw->corrected);
  // The clock of intel.relations, whose first relation is about this scan.
  EXPECT_EQ(raw->scans[0].time.time_since_epoch().count(), 976052890244111000);

  const auto corrected = read_log(folder / "intel_corrected.log.gz");
  ASSERT_TRUE(corrected.ok()) << corrected.error().reason;
  EXPECT_EQ(corrected->scans.size(), 910U);
  EXPECT_TRUE(corrected->corrected);
  EXPECT_EQ(corrected->skipped.at("NEFF"), 910U);
  const auto aces = read_log(folder / "aces_corrected.log.gz");
  ASSERT_TRUE(aces.ok()) << aces.error().reason;
  EXPECT_EQ(aces->scans.size(), 440U);
  EXPECT_TRUE(aces->corrected);
  for (const Log* log : {&*raw, &*corrected, &*aces}) {
    for (std::size_t i = 0; i < log->scans.size(); ++i) {
      ASSERT_EQ(log->scans[i].ranges.size(), 180U);
      if (i > 0) {
        ASSERT_GE(log->scans[i].time, log->scans[i - 1].time);
      }
    }
  }
}

}  // namespace
}  // namespace swiftlet::carmen
