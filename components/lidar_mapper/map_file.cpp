// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/lidar_mapper/map_file.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "components/bag/recording.hpp"
#include "components/bag/topic_file.hpp"
#include "components/lidar_mapper/grid_message.hpp"
#include "components/lidar_mapper/map_message.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLidarMap = "lidar/map";

Status write_all(const SlamMap& map, const OccupancyGrid& grid, Time time, mcap::Writer& writer) {
  TopicWriter<swiftlet_maps::msg::LidarMap> lidar_map;
  TopicWriter<nav_msgs::msg::OccupancyGrid> occupancy;
  if (const Status done = lidar_map.open(writer, kLidarMap); !done.ok()) return done;
  if (const Status done = occupancy.open(writer, topic::map.name); !done.ok()) return done;
  if (const Status done = lidar_map.write(writer, time, to_msg(map, time)); !done.ok()) return done;
  if (const Status done = occupancy.write(writer, time, to_msg(grid, time)); !done.ok()) {
    return done;
  }
  return writer.close();
}

}  // namespace

Status save_map_file(const SlamMap& map, const OccupancyGrid& grid, Time time,
                     const fs::path& file) {
  fs::path beside = file;
  beside += ".partial";
  mcap::WriterParams params;
  params.profile = "ros2";
  params.overwrite = true;
  auto writer = mcap::Writer::open(beside, params);
  if (!writer.ok()) return writer.error();
  std::error_code error;
  if (const Status written = write_all(map, grid, time, *writer); !written.ok()) {
    fs::remove(beside, error);
    return written;
  }
  fs::rename(beside, file, error);
  if (error) return Error{fmt::format("{}: {}", file.string(), error.message())};
  return {};
}

Result<SlamMap> load_map_file(const fs::path& file) {
  const auto recording = Recording::open({file});
  if (!recording.ok()) return recording.error();
  const auto found = last_message<swiftlet_maps::msg::LidarMap>(*recording, kLidarMap);
  if (!found.ok()) return found.error();
  auto map = from_msg(*found);
  if (!map.ok()) return Error{fmt::format("{}: {}", file.string(), map.error().reason)};
  if (map->scans.empty()) return Error{fmt::format("{}: a map without a scan", file.string())};
  return map;
}

}  // namespace swiftlet
