// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/cloud_io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <sstream>

namespace swiftlet {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A reader that goes by the header alone, as any other program does: one line of `key rest...`
/// after the other, up to the line with which the header ends; then the points.
struct Read {
  std::multimap<std::string, std::string> header;
  std::string body;

  std::string value(const std::string& key) const {
    const auto found = header.find(key);
    return found == header.end() ? "" : found->second;
  }
  Eigen::Vector3f point(std::size_t index) const {
    Eigen::Vector3f point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::uint32_t bits = 0;
      for (std::size_t byte = 4; byte-- > 0;) {
        bits = bits << 8 | static_cast<unsigned char>(body.at(12 * index + 4 * axis + byte));
      }
      float value = 0.0F;
      std::memcpy(&value, &bits, sizeof(value));
      point[static_cast<Eigen::Index>(axis)] = value;
    }
    return point;
  }
};

Read read_cloud(const std::string& bytes, const std::string& last_line) {
  Read read;
  std::istringstream stream(bytes);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t space = line.find(' ');
    read.header.emplace(line.substr(0, space),
                        space == std::string::npos ? "" : line.substr(space + 1));
    if (line == last_line) break;
  }
  read.body.assign(std::istreambuf_iterator<char>(stream), {});
  return read;
}

std::vector<Eigen::Vector3d> some_points(std::size_t count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-80.0, 80.0);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(number(random), number(random), number(random));
  }
  return points;
}

void expect_same(const Read& read, const std::vector<Eigen::Vector3d>& points) {
  ASSERT_EQ(read.body.size(), 12 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(read.point(i), points[i].cast<float>()) << "point " << i;
  }
}

TEST(CloudFile, PlyIsReadByItsHeader) {
  const auto points = some_points(1000);
  const Read read = read_cloud(format_cloud(CloudForm::kPly, points), "end_header");
  EXPECT_EQ(read.value("format"), "binary_little_endian 1.0");
  EXPECT_EQ(read.value("element"), "vertex 1000");
  EXPECT_EQ(read.header.count("property"), 3u);
  EXPECT_EQ(format_cloud(CloudForm::kPly, points).rfind("ply\n", 0), 0u);
  expect_same(read, points);
}

TEST(CloudFile, PcdIsReadByItsHeader) {
  const auto points = some_points(777);
  const Read read = read_cloud(format_cloud(CloudForm::kPcd, points), "DATA binary");
  EXPECT_EQ(read.value("VERSION"), "0.7");
  EXPECT_EQ(read.value("FIELDS"), "x y z");
  EXPECT_EQ(read.value("SIZE"), "4 4 4");
  EXPECT_EQ(read.value("TYPE"), "F F F");
  EXPECT_EQ(read.value("COUNT"), "1 1 1");
  EXPECT_EQ(read.value("WIDTH"), "777");
  EXPECT_EQ(read.value("HEIGHT"), "1");
  EXPECT_EQ(read.value("POINTS"), "777");
  expect_same(read, points);
}

TEST(CloudFile, AppearsWholeOrNotAtAllAndSaysWhyNot) {
  const fs::path folder =
      fs::path(testing::TempDir()) / ("swiftlet-cloud-" + std::to_string(getpid()));
  fs::create_directories(folder);
  const auto points = some_points(10);
  ASSERT_TRUE(save_cloud(points, folder / "room.ply").ok());
  std::ifstream stream(folder / "room.ply", std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}),
            format_cloud(CloudForm::kPly, points));
  EXPECT_THAT(save_cloud(points, folder / "room.las").error().reason,
              HasSubstr("saved as .ply or .pcd"));
  EXPECT_THAT(save_cloud({}, folder / "empty.pcd").error().reason, HasSubstr("empty"));
  EXPECT_THAT(save_cloud(points, folder / "none" / "room.pcd").error().reason,
              HasSubstr("does the folder exist"));
  const auto files = std::distance(fs::directory_iterator(folder), fs::directory_iterator());
  EXPECT_EQ(files, 1) << "nothing half-written is left";
  fs::remove_all(folder);
}

}  // namespace
}  // namespace swiftlet
