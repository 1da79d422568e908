// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/euroc/motion_log.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "components/experiments/data_table.hpp"
#include "estimation/geometry/so3.hpp"
#include "tests/components/sim/fixture.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;

constexpr double kBegin = 1403715273.26;

Vector3d position(double t) {
  return {std::sin(t), 2.0 * std::cos(0.5 * t), 0.1 * t};
}
Vector3d velocity(double t) {
  return {std::cos(t), -std::sin(0.5 * t), 0.1};
}
Eigen::Quaterniond attitude(double t) {
  return from_yaw(0.8 * t);
}

std::string tum(double rate_hz) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (int i = 0; i < 5 * rate_hz; ++i) {
    const double t = i / rate_hz;
    const Vector3d p = position(t);
    const Eigen::Quaterniond q = attitude(t);
    text += fmt::format("{:.5f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n", kBegin + t,
                        p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  }
  return text;
}

std::string euroc(double rate_hz) {
  std::string text = "#time(ns),px,py,pz,qw,qx,qy,qz,vx,vy,vz\n\n";
  for (int i = 0; i < 5 * rate_hz; ++i) {
    const double t = i / rate_hz;
    const Vector3d p = position(t), v = velocity(t);
    const Eigen::Quaterniond q = attitude(t);
    text += fmt::format("{:.0f},{},{},{},{},{},{},{},{},{},{}\r\n", (kBegin + t) * 1e9, p.x(),
                        p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), v.x(), v.y(), v.z());
  }
  return text;
}

void expect_motion(const std::filesystem::path& file, double tolerance) {
  const auto log = MotionLog::read(file);
  ASSERT_TRUE(log.ok()) << log.error().reason;
  for (double t = 0.2; t < 4.7; t += 0.0137) {
    const auto state = log->at(log->begin() + from_seconds(t));
    ASSERT_TRUE(state.has_value()) << t;
    EXPECT_LT((state->p_WB - position(t)).norm(), tolerance);
    EXPECT_LT((state->v_WB_W - velocity(t)).norm(), 20 * tolerance);
    EXPECT_LT(log_so3(state->q_WB * attitude(t).conjugate()).norm(), 1e-4);
    EXPECT_NEAR(state->w_WB_B.z(), 0.8, 1e-3);
  }
  EXPECT_FALSE(log->at(log->begin() - Duration(1000)).has_value());
  EXPECT_FALSE(log->at(log->end() + Duration(1000)).has_value());
  EXPECT_TRUE(log->at(log->begin()).has_value());
  EXPECT_TRUE(log->at(log->end()).has_value());
}

TEST(MotionLog, ReadsBothFormsAndWhatIsBetweenTheirSamples) {
  const test::TemporaryFolder folder;
  expect_motion(folder.write("gt.tum.txt", tum(200.0)), 1e-3);
  expect_motion(folder.write("gt.csv", euroc(20.0)), 1e-5);
}

TEST(MotionLog, NothingIsMadeUpInAGap) {
  const test::TemporaryFolder folder;
  const auto log = MotionLog::read(
      folder.write("gt.txt", "1 0 0 0 0 0 0 1\n1.1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n"));
  ASSERT_TRUE(log.ok());
  EXPECT_TRUE(log->at(Time(from_seconds(1.05))).has_value());
  EXPECT_FALSE(log->at(Time(from_seconds(1.5))).has_value());
}

TEST(MotionLog, SaysWhatIsWrongWithAFile) {
  const test::TemporaryFolder folder;
  const auto reason = [&](const std::string& content) {
    const auto log = MotionLog::read(folder.write("gt.txt", content));
    return log.ok() ? "" : log.error().reason;
  };
  EXPECT_THAT(reason("1 2 3\n"), AllOf(HasSubstr("gt.txt"), HasSubstr("3 columns")));
  EXPECT_THAT(reason("# nothing\n"), HasSubstr("no numbers"));
  EXPECT_THAT(reason("1 0 0 0 0 0 0 1\n2 0 0 0 0 zero 0 1\n"), HasSubstr("gt.txt:2"));
  EXPECT_THAT(reason("1 0 0 0 0 0 0 1\n2 0 0 0\n"), HasSubstr("gt.txt:2"));
  EXPECT_THAT(reason("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"), HasSubstr("does not rise"));
  EXPECT_THAT(reason("1 0 0 0 0 0 0 2\n"), HasSubstr("no pose"));
  EXPECT_THAT(reason("1 nan 0 0 0 0 0 1\n"), HasSubstr("no pose"));
  const auto missing = MotionLog::read(folder.path() / "nowhere.txt");
  ASSERT_FALSE(missing.ok());
  EXPECT_THAT(missing.error().reason, HasSubstr("nowhere.txt"));
}

TEST(DataTable, FindsFilesInAnyDepth) {
  const test::TemporaryFolder folder;
  folder.write("a/b/imu0.csv", "1\n");
  folder.write("imu1.csv.gz", "1\n");
  folder.write("imu.yaml", "1\n");
  const auto files = find_files(folder.path(), R"(imu.*\.csv(\.gz)?)");
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].filename(), "imu0.csv");
  EXPECT_TRUE(find_files(folder.path() / "nowhere", ".*").empty());
}

}  // namespace
}  // namespace swiftlet
