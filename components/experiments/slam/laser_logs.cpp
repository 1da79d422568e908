// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/slam/laser_logs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "components/bag/carmen/gzip_stream.hpp"
#include "components/experiments/data_table.hpp"

namespace swiftlet {
namespace {

namespace fs = std::filesystem;

const std::string kScans = "_scans.txt.gz", kRaw = "_raw.log.gz";
constexpr std::size_t kLeastBeams = 10;
constexpr double kNoReturn = 50.0;  // [m]

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

Result<carmen::Log> read_scans(const fs::path& file) {
  carmen::GzipStream text(file);
  std::string titles;
  std::getline(text, titles);
  const bool has_odometry = titles.find("odom_x") != std::string::npos;
  const auto table = read_table(file);
  if (!table) return table.error();
  const std::size_t first = has_odometry ? 4 : 1;
  if (table->front().size() < first + kLeastBeams) {
    return Error{
        fmt::format("{}: {} columns; a line is 't r0..rN', or 't odom_x odom_y odom_theta "
                    "r0..rN' where the first line of the file names these columns",
                    file.string(), table->front().size())};
  }
  carmen::Log log;
  for (const std::vector<double>& row : *table) {
    carmen::Scan scan;
    scan.time = Time(std::chrono::nanoseconds(std::llround(row[0] * 1e9)));
    scan.angle_min = -M_PI_2;
    scan.angle_increment = M_PI / static_cast<double>(row.size() - first);
    scan.max_range = kNoReturn;
    for (std::size_t i = first; i < row.size(); ++i) {
      scan.ranges.push_back(row[i] < kNoReturn ? static_cast<float>(row[i])
                                               : std::numeric_limits<float>::infinity());
    }
    scan.has_pose = has_odometry;
    if (has_odometry) scan.laser_pose = scan.robot_pose = {row[1], row[2], row[3]};
    scan.line = ++log.lines;
    log.scans.push_back(std::move(scan));
  }
  std::stable_sort(log.scans.begin(), log.scans.end(),
                   [](const carmen::Scan& a, const carmen::Scan& b) { return a.time < b.time; });
  return log;
}

}  // namespace

std::vector<LaserLogFile> find_laser_logs(const fs::path& folder) {
  const std::vector<fs::path> relations = find_files(folder, R"(.+\.relations)");
  std::vector<LaserLogFile> logs;
  for (const fs::path& file : find_files(folder, R"(.+(_scans\.txt|_raw\.log)\.gz)")) {
    const std::string full = file.filename().string();
    const std::string& end = ends_with(full, kScans) ? kScans : kRaw;
    LaserLogFile log{full.substr(0, full.size() - end.size()), file, {}};
    for (const fs::path& candidate : relations) {
      const std::string stem = candidate.stem().string();
      if (log.name.compare(0, stem.size(), stem) != 0) continue;
      if (stem.size() > log.relations.stem().string().size()) log.relations = candidate;
    }
    logs.push_back(std::move(log));
  }
  std::sort(logs.begin(), logs.end(), [](const LaserLogFile& a, const LaserLogFile& b) {
    return std::tie(a.name, a.file) < std::tie(b.name, b.file);
  });
  return logs;
}

Result<carmen::Log> read_laser_log(const fs::path& file) {
  if (ends_with(file.filename().string(), kScans)) return read_scans(file);
  return carmen::read_log(file);
}

}  // namespace swiftlet
