// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/gcs_commands.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "components/introspection/introspection_commands.hpp"
#include "components/runtime/command_line.hpp"
#include "components/runtime/number_check.hpp"
#include "gcs/screen/shell/screen_command.hpp"
#include "gcs/sticks/stick_client.hpp"
#include "gcs/verbs/command_options.hpp"
#include "gcs/verbs/mission_file_verbs.hpp"
#include "gcs/verbs/mission_verbs.hpp"
#include "gcs/verbs/status_view.hpp"
#include "gcs/verbs/verb_end.hpp"
#include "gcs/verbs/verbs.hpp"

namespace swiftlet {
namespace {

namespace command = swiftlet_msgs::msg::ModeCommand_Constants;

using Network = std::shared_ptr<NetworkOptions>;

/// What CLI11 takes for a number can be NaN or infinite.
std::string finite(const std::string& text) {
  double number = 0.0;
  const bool is_finite = CLI::detail::lexical_cast(text, number) && std::isfinite(number);
  return is_finite ? "" : "'" + text + "' is no finite number of metres";
}

void show_status(const NetworkOptions& network, bool json, double patience) {
  Host host(network.host_options("gcs"));
  auto& client = host.emplace<StatusClient>("gcs", from_seconds(patience));
  host.run();
  if (!client.view().status) {
    fmt::print(stderr, "{}\n", nobody_answers(host.domain()));
    throw CLI::RuntimeError(kExitFailed);
  }
  fmt::print("{}\n", json ? to_json(client.view()) : describe(client.view()));
}

void add_simple(CLI::App& group, const Network& network, const char* name, const char* what,
                std::uint8_t code, const std::string& prefix = "") {
  CLI::App* verb = group.add_subcommand(name, what);
  GroundCommand ground_command;
  ground_command.name = prefix + name;
  ground_command.command = code;
  const auto options = std::make_shared<CommandOptions>();
  options->add_to(*verb);
  network->add_to(*verb);
  verb->callback([network, options, ground_command] { options->send(*network, ground_command); });
}

void add_gps(CLI::App& gcs, const Network& network) {
  const auto place = std::make_shared<GlobalWaypoint>();
  CLI::App* verb = gcs.add_subcommand("gps", "Climb, and fly a straight line to a place on Earth");
  verb->add_option("latitude", place->latitude, "WGS84 [deg]")->required()->check(finite);
  verb->add_option("longitude", place->longitude, "WGS84 [deg]")->required()->check(finite);
  verb->add_option("--altitude", place->altitude,
                   "Above the take-off point [m]; else that of the commander's gps_altitude")
      ->check(within(0.1, 1e4));
  const auto options = std::make_shared<CommandOptions>();
  options->add_to(*verb);
  network->add_to(*verb);
  verb->callback([network, options, place] {
    GroundCommand ground_command;
    ground_command.name = "gps";
    ground_command.go_to_global = *place;
    options->send(*network, ground_command);
  });
}

void add_stick(CLI::App& gcs, const Network& network) {
  const auto held = std::make_shared<StickClient::Held>();
  CLI::App* verb = gcs.add_subcommand(
      "stick", "A remote control: keys of this terminal, or sticks held for a while");
  verb->footer(
      "Without --forward and its like, keys steer: w s forward and back, a d left and right, i k "
      "up "
      "and\ndown, j l turn, m Manual or Assisted Manual, space lets go, Ctrl-C ends.");
  std::vector<CLI::Option*> sticks;
  const auto add = [&](const char* name, double& value, const char* what) {
    sticks.push_back(verb->add_option(name, value, what)->check(within(-1.0, 1.0)));
  };
  add("--forward", held->sticks.forward, "-1 to 1");
  add("--left", held->sticks.left, "-1 to 1");
  add("--up", held->sticks.up, "-1 to 1");
  add("--turn", held->sticks.turn, "-1 to 1, counter-clockwise");
  sticks.push_back(verb->add_option("--for", held->duration_s, "Hold them for so long [s]")
                       ->check(within(0.05, 3600.0)));
  verb->add_flag("--assisted", held->sticks.assisted,
                 "Take over into Assisted Manual rather than Manual");
  network->add_to(*verb);
  verb->callback([network, held, sticks] {
    const bool is_held =
        std::any_of(sticks.begin(), sticks.end(), [](auto* option) { return option->count() > 0; });
    Terminal terminal;
    if (!is_held && !terminal.has_keys()) {
      fmt::print(
          stderr,
          "stick: there is no terminal to read keys from; say what to hold: --forward, --left, "
          "--up, --turn, --for\n");
      throw CLI::RuntimeError(2);
    }
    Host host(network->host_options("gcs"));
    // A script that holds sticks for a while is nobody to be missed afterwards.
    if (!is_held) host.emplace<Heartbeat>("heartbeat");
    host.emplace<StickClient>("gcs", *held, !is_held, terminal);
    const int code = host.run();
    if (code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace

void add_gcs_commands(CLI::App& gcs) {
  gcs.require_subcommand(0, 1);
  const auto network = std::make_shared<NetworkOptions>();
  add_screen(gcs, network);
  add_simple(gcs, network, "arm", "Let the rotors turn", command::ARM);
  add_simple(gcs, network, "disarm", "Stop the rotors, on the ground", command::DISARM);
  add_simple(gcs, network, "land", "Descend here until the ground is felt", command::LAND);
  add_simple(gcs, network, "hover", "Stop, and hold this place", command::HOVER);

  add_simple(gcs, network, "explore", "Look at all that can be reached, and come back",
             command::EXPLORE);

  add_simple(gcs, network, "manual", "Fly with the sticks: swiftlet gcs stick, or a remote control",
             command::MANUAL);
  add_simple(gcs, network, "assist", "The same, and stop at obstacles", command::ASSIST);
  add_simple(gcs, network, "return", "Fly back to the take-off point, and land there",
             command::RETURN);
  add_gps(gcs, network);
  add_stick(gcs, network);

  CLI::App* mission = gcs.add_subcommand("mission", "Missions: files, and what the vehicle has");
  mission->require_subcommand(1);
  add_mission_file_verbs(*mission);
  add_mission_verbs(*mission, network);
  CLI::App* claw = gcs.add_subcommand("claw", "What the vehicle carries");
  claw->require_subcommand(1);
  add_simple(*claw, network, "open", "Let go", command::CLAW_OPEN, "claw ");
  add_simple(*claw, network, "close", "Take hold", command::CLAW_CLOSE, "claw ");

  auto altitude = std::make_shared<double>(kUsualAltitude);
  CLI::App* takeoff = gcs.add_subcommand("takeoff", "Climb and hover");
  takeoff->add_option("altitude", *altitude, "Above the take-off point [m]")
      ->capture_default_str()
      ->check(finite);
  const auto takeoff_options = std::make_shared<CommandOptions>();
  takeoff_options->add_to(*takeoff);
  network->add_to(*takeoff);
  takeoff->callback([network, takeoff_options, altitude] {
    GroundCommand ground_command;
    ground_command.name = "takeoff";
    ground_command.command = command::TAKEOFF;
    ground_command.altitude = *altitude;
    takeoff_options->send(*network, ground_command);
  });

  auto place = std::make_shared<GroundCommand::Place>();
  CLI::App* go_to = gcs.add_subcommand("goto", "Fly to a place in the map, around obstacles");
  go_to->add_option("x", place->x, "[m]")->required()->check(finite);
  go_to->add_option("y", place->y, "[m]")->required()->check(finite);
  go_to->add_option("z", place->z, "[m]; else at the height that it has")->check(finite);
  const auto goto_options = std::make_shared<CommandOptions>();
  goto_options->add_to(*go_to);
  network->add_to(*go_to);
  go_to->callback([network, goto_options, place] {
    GroundCommand ground_command;
    ground_command.name = "goto";
    ground_command.go_to = *place;
    goto_options->send(*network, ground_command);
  });

  const auto json = std::make_shared<bool>(false);
  const auto patience = std::make_shared<double>(to_seconds(StatusClient::kPatience));
  CLI::App* status = gcs.add_subcommand("status", "What the vehicle is doing");
  status->add_flag("--json", *json, "For scripts");
  add_answer_patience(*status, *patience);
  network->add_to(*status);
  status->callback([network, json, patience] { show_status(*network, *json, *patience); });

  CLI::App* watch = gcs.add_subcommand("watch", "A line a second, until Ctrl-C");
  const auto watch_json = std::make_shared<bool>(false);
  watch->add_flag("--json", *watch_json, "For scripts: an object a line");
  network->add_to(*watch);
  watch->callback([network, watch_json] {
    Host host(network->host_options("gcs"));
    host.emplace<Heartbeat>("heartbeat");
    host.emplace<StatusClient>("gcs", *watch_json ? to_json_line : one_line);
    host.run();
  });

  add_mode_verb(gcs, network);
  add_follow_verb(gcs, network);
  add_waypoint_verbs(gcs, network);
  add_map_verbs(gcs, network);
  add_cloud_verbs(gcs, network);
  add_battery_verb(gcs, network);
  add_log_verb(gcs, network);
  add_param_commands(gcs);
}

}  // namespace swiftlet
