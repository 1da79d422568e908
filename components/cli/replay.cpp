// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "components/bag/bag_info.hpp"
#include "components/bag/player.hpp"
#include "components/cli/map_keeper.hpp"
#include "components/cli/verbs.hpp"
#include "components/runtime/command_line.hpp"
#include "perception/map_io.hpp"

namespace swiftlet {
namespace {

struct ReplayOptions {
  std::string file;
  std::vector<std::string> into;
  std::string map;
  ParameterOptions parameters;
};

/// Refuses a place where a map cannot be saved, before the work is done.
void check_map_file(const std::filesystem::path& file) {
  if (file.extension() != ".pgm" && file.extension() != ".png") {
    throw ConfigError(fmt::format(
        "--map {}: a map is saved as .pgm or .png; end it with one of them", file.string()));
  }
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!std::filesystem::is_directory(folder)) {
    throw ConfigError(
        fmt::format("--map {}: there is no folder {}; make it", file.string(), folder.string()));
  }
}

/// Runs components in lockstep on recorded inputs.
int replay(const ReplayOptions& options) {
  const auto reader = mcap::Reader::open(options.file);
  if (!reader.ok()) throw ConfigError(reader.error().reason);
  if (!options.map.empty()) check_map_file(options.map);
  // A recording that was cut off is replayed as far as it goes.
  for (const Error& error : reader->damage()) {
    fmt::print(stderr, "warning: {}\n", printable(error.reason));
  }
  Config parameters = options.parameters.load();
  HostOptions host_options;
  host_options.lockstep = true;
  host_options.start = mcap::to_time(reader->statistics().message_start_time);
  Host host(host_options);
  for (const std::string& name : options.into) host.add(name, parameters.child(name));
  ParameterOptions::finish(parameters, options.into);
  auto& map = host.emplace<MapKeeper>("map_keeper");
  // What the components write themselves is not played to them.
  PlayerParams player_params;
  for (const Endpoint& endpoint : host.participant()->graph().endpoints()) {
    if (endpoint.is_writer) player_params.except.push_back(endpoint.topic);
  }
  player_params.stop_at_end = true;
  auto& player = host.emplace<Player>("player", *reader, player_params);
  if (player.channels() == 0) {
    throw ConfigError(fmt::format("{}: holds no messages that could be played", options.file));
  }
  const int exit_code = host.run();
  if (exit_code != 0) return exit_code;
  if (player.damaged_chunks() > 0) {
    fmt::print(stderr,
               "swiftlet: {}: {} chunks are damaged and were left out, so the outcome would be "
               "wrong; `swiftlet bag verify` says more\n",
               options.file, player.damaged_chunks());
    return 1;
  }
  fmt::print("replayed   {} messages of {} topics\n", player.played(), player.channels());

  if (options.map.empty()) return 0;
  const auto grid = map.latest();
  if (!grid) {
    fmt::print(stderr,
               "swiftlet: {}: there was no map to save: replay into lidar_mapper, from a recording "
               "with scan and odometry\n",
               options.map);
    return 1;
  }
  const Status saved = save_map(*grid, options.map);
  if (!saved.ok()) {
    fmt::print(stderr, "swiftlet: {}\n", saved.error().reason);
    return 1;
  }
  fmt::print("map        {} ({} x {} cells of {} m)\n", options.map, grid->width(), grid->height(),
             grid->resolution());
  return 0;
}

}  // namespace

void add_replay(CLI::App& app) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* verb =
      app.add_subcommand("replay", "Run components in lockstep on the inputs of a recording");
  verb->add_option("file", options->file, "MCAP file")->required();
  verb->add_option("--into", options->into, "Components to run")->required();
  verb->add_option("--map", options->map, "Save the last map here (.pgm with .yaml, or .png)");
  options->parameters.add_to(*verb);
  verb->callback([options] {
    if (const int code = replay(*options); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace swiftlet
