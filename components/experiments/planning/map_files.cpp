// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/planning/map_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <tuple>

#include "components/bag/carmen/gzip_stream.hpp"
#include "components/experiments/data_table.hpp"

namespace swiftlet {
namespace {

namespace fs = std::filesystem;

const std::string kFree = ".GS";

/// A text file, line by line, that knows where it is.
class Lines {
 public:
  explicit Lines(const fs::path& file) : file_(file), stream_(file) {}

  /// The words of the next line that is not empty; false at the end.
  bool next(std::istringstream& words) {
    std::string line;
    while (std::getline(stream_, line)) {
      ++number_;
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      words.clear();
      words.str(line);
      return true;
    }
    return false;
  }
  Error error(const std::string& what) const {
    return Error{fmt::format("{}:{}: {}", file_.string(), number_, what)};
  }
  /// Of the file as a whole: to be asked when all is read.
  Status state() const {
    if (!stream_.error().empty()) {
      return Error{fmt::format("{}: {}", file_.string(), stream_.error())};
    }
    if (stream_.bad()) return Error{fmt::format("{}: is damaged or cut off", file_.string())};
    return {};
  }

 private:
  fs::path file_;
  carmen::GzipStream stream_;
  int number_ = 0;
};

/// "type octile", "height H", "width W", "map", then H rows of W characters.
Result<VoxelGrid> read_plane(const fs::path& file) {
  Lines lines(file);
  std::istringstream words;
  int width = 0, height = 0;
  std::string key;
  while (key != "map" && lines.next(words)) {
    words >> key;
    if (key == "height") words >> height;
    if (key == "width") words >> width;
  }
  if (const Status state = lines.state(); !state.ok()) return state.error();
  if (key != "map") return lines.error("no line 'map' before the end");
  auto grid = VoxelGrid::make(width, height, 1);
  if (!grid.ok()) return lines.error(grid.error().reason);
  for (int y = 0; y < height; ++y) {
    if (!lines.next(words)) return lines.error(fmt::format("{} rows of {}", y, height));
    std::string row;
    words >> row;
    if (row.size() != static_cast<std::size_t>(width)) {
      return lines.error(fmt::format("{} characters in a row of {}", row.size(), width));
    }
    for (int x = 0; x < width; ++x) {
      const bool free = kFree.find(row[static_cast<std::size_t>(x)]) != std::string::npos;
      grid->set_blocked({x, y, 0}, !free);
    }
  }
  if (const Status state = lines.state(); !state.ok()) return state.error();
  return grid;
}

/// "voxel X Y Z", then a blocked voxel a line.
Result<VoxelGrid> read_space(const fs::path& file) {
  Lines lines(file);
  std::istringstream words;
  Voxel size;
  std::string key;
  if (!lines.next(words) || !(words >> key >> size.x >> size.y >> size.z) || key != "voxel") {
    if (const Status state = lines.state(); !state.ok()) return state.error();
    return lines.error("not 'voxel X Y Z'");
  }
  auto grid = VoxelGrid::make(size.x, size.y, size.z);
  if (!grid.ok()) return lines.error(grid.error().reason);
  while (lines.next(words)) {
    Voxel voxel;
    if (!(words >> voxel.x >> voxel.y >> voxel.z)) return lines.error("not three whole numbers");
    if (!grid->contains(voxel)) return lines.error("a voxel outside of the map");
    grid->set_blocked(voxel);
  }
  if (const Status state = lines.state(); !state.ok()) return state.error();
  return grid;
}

/// "bucket map width height sx sy gx gy length" or "sx sy sz gx gy gz length ratio"; lines before
/// the first of these are titles.
Status read_problems(const PlanningMapFile& file, std::size_t most, PlanningMap& map) {
  Lines lines(file.problems);
  std::istringstream words;
  while (lines.next(words)) {
    PlanningProblem problem;
    if (file.in_space) {
      words >> problem.start.x >> problem.start.y >> problem.start.z >> problem.goal.x >>
          problem.goal.y >> problem.goal.z;
    } else {
      std::string bucket, name, width, height;
      words >> bucket >> name >> width >> height >> problem.start.x >> problem.start.y >>
          problem.goal.x >> problem.goal.y;
    }
    if (!(words >> problem.octile_length)) {
      if (map.problems.empty()) continue;
      return lines.error("not a problem as the lines before");
    }
    for (const Voxel end : {problem.start, problem.goal}) {
      if (!map.grid.contains(end)) return lines.error("starts or ends outside of the map");
      if (map.grid.blocked(end)) return lines.error("starts or ends in what is blocked");
    }
    map.problems.push_back(problem);
  }
  if (const Status state = lines.state(); !state.ok()) return state.error();
  if (map.problems.empty()) return lines.error("no problem in it");
  const std::size_t left_out = map.problems.size() - std::min(most, map.problems.size());
  map.problems.erase(map.problems.begin(),
                     map.problems.begin() + static_cast<std::ptrdiff_t>(left_out));
  return {};
}

}  // namespace

std::vector<PlanningMapFile> find_planning_maps(const fs::path& folder) {
  std::vector<PlanningMapFile> files;
  for (const fs::path& map : find_files(folder, R"(.+\.(map|3dmap)\.gz)")) {
    const std::string stem = map.stem().string();  // X.map
    PlanningMapFile file{
        fs::path(stem).stem().string(), map, {}, fs::path(stem).extension() == ".3dmap"};
    file.problems = map.parent_path() / (stem + (file.in_space ? ".3dscen.gz" : ".scen.gz"));
    std::error_code ignored;
    if (fs::exists(file.problems, ignored)) files.push_back(std::move(file));
  }
  std::sort(files.begin(), files.end(), [](const PlanningMapFile& a, const PlanningMapFile& b) {
    return std::tie(a.in_space, a.name, a.map) < std::tie(b.in_space, b.name, b.map);
  });
  return files;
}

Result<PlanningMap> read_planning_map(const PlanningMapFile& file, std::size_t most) {
  auto grid = file.in_space ? read_space(file.map) : read_plane(file.map);
  if (!grid.ok()) return grid.error();
  PlanningMap map{std::move(grid).value(), {}};
  if (const Status read = read_problems(file, most, map); !read.ok()) return read.error();
  return map;
}

}  // namespace swiftlet
