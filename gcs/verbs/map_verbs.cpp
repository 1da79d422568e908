// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "components/lidar_mapper/grid_message.hpp"
#include "components/runtime/number_check.hpp"
#include "components/terminal/terminal.hpp"
#include "estimation/basics/whole_file.hpp"
#include "gcs/screen/map_scene.hpp"
#include "gcs/screen/shell/locale_text.hpp"
#include "gcs/verbs/map_client.hpp"
#include "gcs/verbs/verb_end.hpp"
#include "gcs/verbs/verbs.hpp"
#include "perception/map_io.hpp"

namespace swiftlet {
namespace {

using Network = std::shared_ptr<NetworkOptions>;

struct Options {
  std::string file;
  double patience = 5.0;
  int width = 0;  // 0: as the terminal
  bool ascii = false, json = false;
};

/// Runs the client until a map was heard; without one it is the verb's end.
const MapClient& hear_map(Host& host, const Options& options, bool scene) {
  const auto& client = host.emplace<MapClient>("gcs", from_seconds(options.patience), scene);
  const int code = host.run();
  if (!client.map()) {
    end_verb(kExitFailed,
             code == 0 ? "interrupted"
                       : fmt::format("no map is heard in domain {} for {:g} s; does lidar_mapper "
                                     "run there, and is --vehicle right?",
                                     host.domain(), options.patience));
  }
  return client;
}

void show(const NetworkOptions& network, const Options& options) {
  Host host(network.host_options("gcs"));
  const MapClient& client = hear_map(host, options, true);
  const screen::GroundStationModel& model = client.model();
  const int width = options.width > 0 ? options.width : screen::terminal_width();
  const bool ascii = options.ascii || !screen::locale_is_utf8();
  const std::string text = screen::map_text(model, host.executor().now(), width, ascii);
  if (text.empty()) end_verb(kExitFailed, "the map is empty: nothing was seen yet");
  const Eigen::Vector2d size = model.map_extent()->upper - model.map_extent()->lower;
  fmt::print("{}{:.1f} x {:.1f} m in cells of {:g} m", text, size.x(), size.y(),
             model.map()->resolution);
  if (model.pose().known()) {
    fmt::print(", the vehicle at {:.2f} {:.2f} m", model.pose()->p_WB.x(), model.pose()->p_WB.y());
  }
  fmt::print("\n");
}

/// Before it listens, rather than after.
void check_file(const std::filesystem::path& file) {
  if (const Status place = check_map_file(file); !place.ok()) {
    end_verb(kExitUnusable, place.error().reason);
  }
}

void save(const NetworkOptions& network, const Options& options) {
  check_file(options.file);
  Host host(network.host_options("gcs"));
  const MapClient& client = hear_map(host, options, false);
  const OccupancyGrid grid = from_msg(*client.map(), OccupancyGrid::Params());
  if (grid.empty()) {
    end_verb(kExitFailed, "the map that is heard has no cells, or is turned against its axes");
  }
  const Status saved = save_map(grid, options.file);
  if (!saved.ok()) end_verb(kExitUnusable, saved.error().reason);
  if (options.json) {
    const nlohmann::ordered_json json = {{"file", options.file},
                                         {"width", grid.width()},
                                         {"height", grid.height()},
                                         {"resolution_m", grid.resolution()},
                                         {"origin_m", {grid.origin().x(), grid.origin().y()}}};
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return;
  }
  fmt::print("{}: {} x {} cells of {:g} m\n", options.file, grid.width(), grid.height(),
             grid.resolution());
}

void add_patience(CLI::App& verb, Options& options) {
  verb.add_option("--patience", options.patience, "Wait so long for a map [s]")
      ->capture_default_str()
      ->check(within(0.5, 600.0));
}

void add_show(CLI::App& group, const Network& network) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = group.add_subcommand("show", "Draw it in the terminal, with the vehicle on it");
  verb->add_flag("--ascii", options->ascii, "No other characters, whatever the locale");
  verb->add_option("--width", options->width, "Columns; else those of the terminal, or 80")
      ->check(within(20.0, 1000.0));
  add_patience(*verb, *options);
  network->add_to(*verb);
  verb->footer(
      "North is up. An arrow is the vehicle, H where it took off, a line its path; small dots were "
      "seen to be free.");
  verb->callback([network, options] { show(*network, *options); });
}

void add_save(CLI::App& group, const Network& network) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = group.add_subcommand(
      "save", "Write it: .pgm with a .yaml beside it, as the map_server of ROS does, or .png");
  verb->add_option("file", options->file, "MAP.pgm, whose MAP.yaml is replaced with it, or MAP.png")
      ->required();
  add_patience(*verb, *options);
  verb->add_flag("--json", options->json, "For scripts");
  network->add_to(*verb);
  verb->footer(
      "A file appears whole or not at all.\n"
      "Exit codes: 0 written, 1 no map was heard, 2 it cannot be written there.");
  verb->callback([network, options] { save(*network, *options); });
}

}  // namespace

void add_map_verbs(CLI::App& gcs, const Network& network) {
  CLI::App* group = gcs.add_subcommand("map", "The vehicle's map");
  group->require_subcommand(1);
  add_show(*group, network);
  add_save(*group, network);
}

}  // namespace swiftlet
