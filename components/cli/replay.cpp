// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

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

/// Runs components in lockstep on recorded inputs.
int replay(const ReplayOptions& options) {
  const auto reader = mcap::Reader::open(options.file);
  if (!reader.ok()) throw ConfigError(reader.error().reason);
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
