// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// A real log through the whole program: CARMEN log, recording, replay into lidar_mapper, map file.
// The map is compared cell for cell with one that is drawn here from the lines of the log, with
// nothing of the project's: reading, beams, evidence and file format are all done again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/components/bag/temporary_folder.hpp"
#include "tests/data_folder.hpp"
#include "tests/system/system_test.hpp"

namespace swiftlet {
namespace {

constexpr double kPi = 3.14159265358979323846;

// The documented rules of the map (perception/occupancy_grid.hpp, lidar_mapper).
constexpr double kResolution = 0.05;                         // [m]
constexpr int kHitEvidence = 847, kMissEvidence = -405;      // 1000 ln(0.7/0.3), 1000 ln(0.4/0.6)
constexpr int kLeastEvidence = -2944, kMostEvidence = 3476;  // of probabilities 0.05 and 0.97
constexpr double kMinRange = 0.01, kMaxRange = 50.0;         // as converted [m]
constexpr std::int64_t kParts = 4096;  // ends of beams are rounded to this part of a cell

struct LogScan {
  double x = 0, y = 0, theta = 0, time = 0;  // of the laser [m, rad, s]
  std::vector<float> ranges;
};

/// FLASER n r1..rn x y theta odom_x odom_y odom_theta ipc_time host logger_time
std::vector<LogScan> read_log(const std::filesystem::path& path) {
  std::vector<LogScan> scans;
  gzFile file = gzopen(path.c_str(), "rb");
  std::array<char, 1 << 16> line{};
  while (gzgets(file, line.data(), line.size()) != nullptr) {
    std::istringstream words(line.data());
    std::string keyword;
    std::size_t beams = 0;
    if (!(words >> keyword) || keyword != "FLASER" || !(words >> beams)) continue;
    LogScan scan;
    scan.ranges.resize(beams);
    for (float& range : scan.ranges) words >> range;
    double unused = 0;
    words >> scan.x >> scan.y >> scan.theta >> unused >> unused >> unused >> scan.time;
    scans.push_back(scan);
  }
  gzclose(file);
  // The log has some out of order; a recording is in the order of time.
  std::stable_sort(scans.begin(), scans.end(),
                   [](const LogScan& a, const LogScan& b) { return a.time < b.time; });
  return scans;
}

struct CellIndex {
  std::int64_t x = 0, y = 0;
  bool operator<(const CellIndex& other) const {
    return std::make_pair(y, x) < std::make_pair(other.y, other.x);
  }
};

std::int64_t floor_div(std::int64_t a, std::int64_t b) {  // b > 0
  return a >= 0 ? a / b : -((-a + b - 1) / b);
}

/// A position in parts of a cell.
struct Point {
  std::int64_t x = 0, y = 0;
  CellIndex cell() const { return {floor_div(x, kParts), floor_div(y, kParts)}; }
};

Point rounded(double x, double y) {
  return {std::llround(x / kResolution * kParts), std::llround(y / kResolution * kParts)};
}

/// The cells whose interior the segment crosses, and those of its ends: row by row, from where it
/// enters a row to where it leaves it, in exact fractions.
void add_cells(const Point& a, const Point& b, std::vector<CellIndex>& cells) {
  const Point& low = a.y < b.y ? a : b;
  const Point& high = a.y < b.y ? b : a;
  const std::int64_t dx = high.x - low.x, dy = high.y - low.y;
  cells.push_back(a.cell());
  cells.push_back(b.cell());
  for (std::int64_t row = low.cell().y; row <= high.cell().y; ++row) {
    // x in the row is from/scale to to/scale.
    std::int64_t from = low.x, to = high.x, scale = 1;
    if (dy > 0) {
      const std::int64_t enter = std::max(low.y, row * kParts);
      const std::int64_t leave = std::min(high.y, (row + 1) * kParts);
      if (enter >= leave) continue;
      from = low.x * dy + dx * (enter - low.y);
      to = low.x * dy + dx * (leave - low.y);
      scale = dy;
    }
    if (from > to) std::swap(from, to);
    const std::int64_t first = floor_div(from, scale * kParts);
    const std::int64_t last = -floor_div(-to, scale * kParts) - 1;
    for (std::int64_t x = first; x <= last; ++x) cells.push_back({x, row});
  }
}

enum State { kFree, kUnknown, kOccupied };

class LogOddsMap {
 public:
  void add(const LogScan& scan) {
    std::vector<CellIndex> crossed, hit;
    const Point origin = rounded(scan.x, scan.y);
    for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
      const double range = static_cast<double>(scan.ranges[i]);
      if (!(range >= kMinRange && range < kMaxRange)) continue;
      const Point end = end_of(scan, i);
      add_cells(origin, end, crossed);
      hit.push_back(end.cell());
    }
    std::sort(hit.begin(), hit.end());
    std::sort(crossed.begin(), crossed.end());
    const auto same = [](const CellIndex& a, const CellIndex& b) { return !(a < b) && !(b < a); };
    crossed.erase(std::unique(crossed.begin(), crossed.end(), same), crossed.end());
    for (const CellIndex& cell : crossed) {
      const bool is_hit = std::binary_search(hit.begin(), hit.end(), cell);
      int& evidence = evidence_[cell];
      evidence = std::clamp(evidence + (is_hit ? kHitEvidence : kMissEvidence), kLeastEvidence,
                            kMostEvidence);
    }
  }

  static Point end_of(const LogScan& scan, std::size_t beam) {
    // Angles and ranges travel as 32-bit numbers: 180 beams from -90 degrees on, a degree apart.
    const double first = static_cast<double>(static_cast<float>(-kPi / 2));
    const double step = static_cast<double>(static_cast<float>(kPi / 180));
    const double angle = scan.theta + first + static_cast<double>(beam) * step;
    const double range = static_cast<double>(scan.ranges[beam]);
    return rounded(scan.x + range * std::cos(angle), scan.y + range * std::sin(angle));
  }

  /// The map travels in whole percent; above 65 is occupied, below 35 free.
  State state(const CellIndex& cell) const {
    const auto found = evidence_.find(cell);
    if (found == evidence_.end()) return kUnknown;
    const double odds = std::exp(found->second / 1000.0);
    const long percent = std::lround(100.0 * odds / (1.0 + odds));
    return percent > 65 ? kOccupied : percent < 35 ? kFree : kUnknown;
  }

  const std::map<CellIndex, int>& evidence() const { return evidence_; }

 private:
  std::map<CellIndex, int> evidence_;
};

/// A map as map_server has it.
struct MapFile {
  std::int64_t width = 0, height = 0;
  CellIndex first;  // lattice index of the lower left cell
  std::string pixels;

  State state(std::int64_t column, std::int64_t row) const {
    const auto index = static_cast<std::size_t>((height - 1 - row) * width + column);
    const auto pixel = static_cast<unsigned char>(pixels[index]);
    EXPECT_TRUE(pixel == 0 || pixel == 205 || pixel == 254) << int{pixel};
    return pixel == 0 ? kOccupied : pixel == 254 ? kFree : kUnknown;
  }
};

std::string text_of(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  return {bytes.begin(), bytes.end()};
}

MapFile read_map(const std::filesystem::path& path) {
  MapFile map;
  std::istringstream pgm(text_of(path));
  std::string magic;
  int white = 0;
  pgm >> magic >> map.width >> map.height >> white;
  EXPECT_EQ(magic, "P5");
  EXPECT_EQ(white, 255);
  pgm.get();
  map.pixels.resize(static_cast<std::size_t>(map.width * map.height));
  EXPECT_TRUE(pgm.read(map.pixels.data(), static_cast<std::streamsize>(map.pixels.size())));
  EXPECT_EQ(pgm.peek(), EOF);

  const std::string yaml = text_of(std::filesystem::path(path).replace_extension(".yaml"));
  double x = 0, y = 0;
  EXPECT_EQ(std::sscanf(yaml.c_str() + yaml.find("origin:"), "origin: [%lf, %lf, 0]", &x, &y), 2);
  EXPECT_NE(yaml.find("resolution: 0.05\n"), std::string::npos);
  map.first = {std::llround(x / kResolution), std::llround(y / kResolution)};
  EXPECT_NEAR(static_cast<double>(map.first.x) * kResolution, x, 1e-9) << "not on the lattice";
  EXPECT_NEAR(static_cast<double>(map.first.y) * kResolution, y, 1e-9) << "not on the lattice";
  return map;
}

class IntelLab : public test::SystemTest {
 protected:
  void SetUp() override {
    log_ = data_folder() / "lidar2d/intel_corrected.log.gz";
    SWIFTLET_SKIP_WITHOUT(log_);
    expect_done({"bag", "convert", "carmen", log_, "-o", path("intel.mcap")});
    replay("out.pgm");
    if (HasFailure()) return;
    scans_ = read_log(log_);
    map_ = read_map(path("out.pgm"));
  }

  void expect_done(const Arguments& arguments) {
    const test::Finished done = run(arguments);
    ASSERT_EQ(done.exit_code, 0) << done.out << done.err;
  }
  void replay(const std::string& map) {
    expect_done({"replay", path("intel.mcap"), "--into", "lidar_mapper", "--map", path(map)});
  }

  State state(const CellIndex& cell) const {
    const std::int64_t column = cell.x - map_.first.x, row = cell.y - map_.first.y;
    const bool inside = column >= 0 && row >= 0 && column < map_.width && row < map_.height;
    return inside ? map_.state(column, row) : kUnknown;
  }

  std::filesystem::path log_;
  std::vector<LogScan> scans_;
  MapFile map_;
};

TEST_F(IntelLab, TheMapIsThatOfTheLogCellForCell) {
  ASSERT_EQ(scans_.size(), 910U);
  LogOddsMap expected;
  for (const LogScan& scan : scans_) expected.add(scan);

  std::array<std::array<int, 3>, 3> cells{};  // of this state here, of that state in the file
  int known = 0;
  for (std::int64_t row = 0; row < map_.height; ++row) {
    for (std::int64_t column = 0; column < map_.width; ++column) {
      const State wanted = expected.state({map_.first.x + column, map_.first.y + row});
      ++cells[wanted][map_.state(column, row)];
      known += wanted != kUnknown;
    }
  }
  for (const auto& [cell, evidence] : expected.evidence()) {
    if (expected.state(cell) != kUnknown) --known;
  }
  EXPECT_EQ(known, 0) << "cells are known that the map file does not cover";
  RecordProperty("free_cells", cells[kFree][kFree]);
  RecordProperty("occupied_cells", cells[kOccupied][kOccupied]);
  EXPECT_GT(cells[kFree][kFree], 150'000);
  EXPECT_GT(cells[kOccupied][kOccupied], 5'000);
  for (const State wanted : {kFree, kUnknown, kOccupied}) {
    for (const State found : {kFree, kUnknown, kOccupied}) {
      if (wanted == found) continue;
      EXPECT_EQ(cells[wanted][found], 0) << "state " << wanted << " became " << found;
    }
  }
}

TEST_F(IntelLab, BeamsEndAtWallsAndTheRobotDroveWhereItIsFree) {
  int returns = 0, at_walls = 0, poses_in_free_cells = 0;
  for (const LogScan& scan : scans_) {
    poses_in_free_cells += state(rounded(scan.x, scan.y).cell()) == kFree;
    for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
      if (static_cast<double>(scan.ranges[i]) >= kMaxRange) continue;
      const CellIndex end = LogOddsMap::end_of(scan, i).cell();
      bool wall = false;
      for (int k = 0; k < 9; ++k)
        wall |= state({end.x + k / 3 - 1, end.y + k % 3 - 1}) == kOccupied;
      ++returns;
      at_walls += wall;
    }
  }
  RecordProperty("returns_at_walls_percent", 100 * at_walls / returns);
  EXPECT_GT(at_walls, 0.9 * returns);
  EXPECT_EQ(poses_in_free_cells, 910);
}

TEST_F(IntelLab, AReplayGivesTheSameFileAndAPictureShowsTheSameMap) {
  replay("again.pgm");
  EXPECT_TRUE(read_bytes(path("again.pgm")) == read_bytes(path("out.pgm")));
  replay("out.png");
  const auto png = read_bytes(path("out.png"));
  ASSERT_GT(png.size(), 24U);
  // Width and height in the header of a PNG file.
  const auto number = [&](std::size_t at) {
    return std::int64_t{png[at + 2]} * 256 + std::int64_t{png[at + 3]};
  };
  EXPECT_EQ(number(16), map_.width);
  EXPECT_EQ(number(20), map_.height);
}

}  // namespace
}  // namespace swiftlet
