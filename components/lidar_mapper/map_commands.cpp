// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/lidar_mapper/map_commands.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "components/lidar_mapper/map_file.hpp"
#include "components/plot/figure.hpp"
#include "components/runtime/number_check.hpp"
#include "perception/map_io.hpp"
#include "perception/rooms/room_survey.hpp"
#include "perception/slam/map_joiner.hpp"

namespace swiftlet {
namespace {

constexpr int kFailed = 1;
constexpr int kUnusable = 2;

[[noreturn]] void fail(int exit_code, const std::string& reason) {
  fmt::print(stderr, "error: {}\n", reason);
  throw CLI::RuntimeError(exit_code);
}

SlamMap load(const std::string& file) {
  auto map = load_map_file(file);
  if (!map.ok()) fail(kUnusable, map.error().reason);
  return std::move(map).value();
}

OccupancyGrid draw(const SlamMap& map, double resolution) {
  OccupancyGrid::Params params;
  params.resolution = resolution;
  params.clear_without_return = false;
  ScanMap drawing(params);
  drawing.update(map.scans, map.graph.poses);
  return drawing.grid();
}

double way_of(const SlamMap& map) {
  double length = 0.0;
  for (std::size_t i = 1; i < map.graph.poses.size(); ++i) {
    length += (map.graph.poses[i].position - map.graph.poses[i - 1].position).norm();
  }
  return length;
}

void run_info(const std::string& file, bool json) {
  const SlamMap map = load(file);
  const OccupancyGrid grid = draw(map, 0.05);
  const double width = grid.width() * grid.resolution(), height = grid.height() * grid.resolution();
  if (json) {
    fmt::print("{}\n", nlohmann::json{{"file", file},
                                      {"keyframes", map.scans.size()},
                                      {"constraints", map.graph.constraints.size()},
                                      {"way_m", way_of(map)},
                                      {"width_m", width},
                                      {"height_m", height}}
                           .dump(2));
    return;
  }
  fmt::print(
      "{}\nkeyframes    {}\nconstraints  {}\nway          {:.1f} m\nextent       {:.1f} x {:.1f} "
      "m\n",
      file, map.scans.size(), map.graph.constraints.size(), way_of(map), width, height);
}

ScanPoints surfaces_of(const SlamGraph& graph) {
  std::vector<int> all(graph.keyframes.size());
  std::iota(all.begin(), all.end(), 0);
  return surfaces_of(graph.keyframes, graph.poses, all);
}

/// The surfaces in black, and beside each room's middle what it measures.
Status draw_rooms(const std::vector<Room>& rooms, const ScanPoints& surfaces,
                  const std::string& image) {
  plot::Figure figure;
  figure.panel_width = figure.panel_height = 900;
  plot::Panel& panel = figure.panel("", "x [m]", "y [m]");
  panel.equal_aspect = true;
  panel.legend = plot::Legend::kNone;
  constexpr std::size_t kDots = 20'000;  // more make no better picture
  const std::size_t step = 1 + surfaces.size() / kDots;
  std::vector<double> x, y;
  for (std::size_t i = 0; i < surfaces.size(); i += step) {
    x.push_back(surfaces[i].position.x());
    y.push_back(surfaces[i].position.y());
  }
  panel.add("", x, y, {plot::kBlack, plot::Dash::kNoLine, plot::Marker::kDot});
  for (const Room& room : rooms) {
    panel.notes.push_back(
        {room.center.x(), room.center.y(),
         fmt::format("{:.2f} m2, {:.2f} x {:.2f} m", room.area, room.length, room.width)});
  }
  return figure.save(image);
}

/// A length or an area, where it was measured.
std::string measured(double value, int digits) {
  return value > 0.0 ? fmt::format("{:.{}f}", value, digits) : "-";
}

void run_rooms(const std::string& file, const std::string& image, double widest_door, bool json) {
  const SlamMap map = load(file);
  const ScanPoints surfaces = surfaces_of(map.graph);
  RoomSurveyParams params;
  params.widest_door = widest_door;
  const std::vector<Room> rooms = survey_rooms(draw(map, 0.05), surfaces, params);
  if (json) {
    nlohmann::json list = nlohmann::json::array();
    for (const Room& room : rooms) {
      list.push_back({{"x_m", room.center.x()},
                      {"y_m", room.center.y()},
                      {"area_m2", room.area},
                      {"plan_area_m2", room.plan_area()},
                      {"length_m", room.length},
                      {"width_m", room.width},
                      {"axis_rad", room.axis}});
    }
    fmt::print("{}\n", list.dump(2));
  } else {
    fmt::print(
        "room     at [m]            floor [m2]   length [m]   width [m]   plan [m2]   (- where a "
        "wall was not seen)\n");
    for (std::size_t i = 0; i < rooms.size(); ++i) {
      fmt::print("{:<4}  {:>7.2f} {:>7.2f}  {:>13.2f} {:>12} {:>11} {:>11}\n", i + 1,
                 rooms[i].center.x(), rooms[i].center.y(), rooms[i].area,
                 measured(rooms[i].length, 3), measured(rooms[i].width, 3),
                 measured(rooms[i].plan_area(), 2));
    }
  }
  if (image.empty()) return;
  const Status drawn = draw_rooms(rooms, surfaces, image);
  if (!drawn.ok()) fail(kFailed, drawn.error().reason);
}

void run_draw(const std::string& file, const std::string& image, double resolution) {
  const Status saved = save_map(draw(load(file), resolution), image);
  if (!saved.ok()) fail(kUnusable, saved.error().reason);
}

void run_merge(const std::vector<std::string>& files, const std::string& output) {
  SlamMap merged = load(files.front());
  for (std::size_t i = 1; i < files.size(); ++i) {
    const SlamMap other = load(files[i]);
    const auto frame = find_frame(merged.graph, other.graph);
    if (!frame) {
      fail(kFailed, fmt::format("{}: too little of it looks like {}; do they show the same place?",
                                files[i], i == 1 ? files.front() : "the maps before it"));
    }
    merged.graph = join_maps(merged.graph, other.graph, *frame);
    merged.scans.insert(merged.scans.end(), other.scans.begin(), other.scans.end());
    fmt::print("{}: at ({:.2f}, {:.2f}) m, turned by {:.1f} deg\n", files[i], frame->position.x(),
               frame->position.y(), frame->yaw * 180.0 / M_PI);
  }
  Time newest = merged.graph.keyframes.front()->time;
  for (const KeyframePtr& keyframe : merged.graph.keyframes) {
    newest = std::max(newest, keyframe->time);
  }
  const Status saved = save_map_file(merged, draw(merged, 0.05), newest, output);
  if (!saved.ok()) fail(kUnusable, saved.error().reason);
}

}  // namespace

void add_map(CLI::App& app) {
  CLI::App* map = app.add_subcommand("map", "Map files of lidar_mapper: look at them, merge them");
  map->require_subcommand(1);

  struct Options {
    std::string file, output;
    std::vector<std::string> files;
    double resolution = 0.05, widest_door = RoomSurveyParams().widest_door;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* info = map->add_subcommand("info", "What a map file holds");
  info->add_option("file", options->file, "Map file (.mcap)")->required();
  info->add_flag("--json", options->json, "For programs");
  info->callback([options] { run_info(options->file, options->json); });

  CLI::App* draw = map->add_subcommand("draw", "Draw it: .pgm with .yaml beside it, or .png");
  draw->add_option("file", options->file, "Map file (.mcap)")->required();
  draw->add_option("-o,--output", options->output, "Image to write")->required();
  draw->add_option("--resolution", options->resolution, "Of a cell [m]")->check(within(0.005, 1.0));
  draw->callback([options] { run_draw(options->file, options->output, options->resolution); });

  CLI::App* rooms = map->add_subcommand(
      "rooms",
      "Its rooms, measured: free floor, from wall to wall both ways, and the area of a floor plan");
  rooms->add_option("file", options->file, "Map file (.mcap)")->required();
  rooms->add_option("--widest-door", options->widest_door, "What is narrower parts rooms [m]")
      ->check(within(0.2, 10.0));
  rooms->add_option("--draw", options->output, "Picture to write (.png)");
  rooms->add_flag("--json", options->json, "For programs");
  rooms->callback([options] {
    run_rooms(options->file, options->output, options->widest_door, options->json);
  });

  CLI::App* merge = map->add_subcommand(
      "merge", "Several maps as one, in the frame of the first; where the others lie is found out");
  merge->add_option("files", options->files, "Map files (.mcap), two or more")
      ->required()
      ->expected(2, -1);
  merge->add_option("-o,--output", options->output, "Map file to write")->required();
  merge->callback([options] { run_merge(options->files, options->output); });
}

}  // namespace swiftlet
