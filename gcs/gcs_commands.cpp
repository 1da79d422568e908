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
#include "components/runtime/number_check.hpp"
#include "gcs/command/ground_options.hpp"
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

using Network = std::shared_ptr<GroundOptions>;

/// For a vehicle to get ready: its estimate settles for eight seconds [s].
constexpr double kReadyPatience = 60.0;
constexpr char kExitCodes[] =
    "Exit codes: 0 done, 1 refused, failed or not answered, 2 what was typed, or a file, cannot be "
    "used.";

/// What CLI11 takes for a number can be NaN or infinite.
std::string finite(const std::string& text) {
  double number = 0.0;
  const bool is_finite = CLI::detail::lexical_cast(text, number) && std::isfinite(number);
  return is_finite ? "" : "'" + text + "' is no finite number of metres";
}

struct StatusOptions {
  bool json = false;
  bool wait = false;
  double patience = 0.0;  // [s]; 0: what is usual
};

void show_status(const GroundOptions& network, const StatusOptions& options) {
  const double usual = options.wait ? kReadyPatience : to_seconds(StatusClient::kPatience);
  const Duration patience = from_seconds(options.patience > 0.0 ? options.patience : usual);
  Terminal terminal;
  Host host(network.host_options("gcs"));
  auto& client = host.emplace<StatusClient>("gcs", patience, options.wait ? &terminal : nullptr);
  host.run();
  terminal.clear();
  if (!client.view().status) {
    fmt::print(stderr, "{}\n", nobody_answers(host.domain()));
    throw CLI::RuntimeError(kExitFailed);
  }
  fmt::print("{}\n", options.json ? to_json(client.view()) : describe(client.view()));
  const auto& status = *client.view().status;
  if (options.wait && !status.ready() && !status.armed()) {
    end_verb(kExitFailed, "it may not be armed: " + status.reason());
  }
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
    if (!is_held)
      host.emplace<Heartbeat>("heartbeat", network->station(), Heartbeat::Absence::kIsMissed);
    host.emplace<StickClient>("gcs", network->station(), *held, !is_held, terminal);
    const int code = host.run();
    if (code != 0) throw CLI::RuntimeError(code);
  });
}

void add_takeoff(CLI::App& gcs, const Network& network) {
  const auto altitude = std::make_shared<double>(kUsualAltitude);
  CLI::App* verb = gcs.add_subcommand("takeoff", "Climb and hover");
  verb->add_option("altitude", *altitude, "Above the take-off point [m]")
      ->capture_default_str()
      ->check(finite);
  const auto options = std::make_shared<CommandOptions>();
  options->add_to(*verb);
  network->add_to(*verb);
  verb->callback([network, options, altitude] {
    GroundCommand ground_command;
    ground_command.name = "takeoff";
    ground_command.command = command::TAKEOFF;
    ground_command.altitude = *altitude;
    options->send(*network, ground_command);
  });
}

void add_goto(CLI::App& gcs, const Network& network) {
  const auto place = std::make_shared<GroundCommand::Place>();
  CLI::App* verb = gcs.add_subcommand("goto", "Fly to a place in the map, around obstacles");
  verb->add_option("x", place->x, "In the map, to the east [m]")->required()->check(finite);
  verb->add_option("y", place->y, "In the map, to the north [m]")->required()->check(finite);
  verb->add_option("z", place->z, "In the map, up [m], not above the ground; else as high as it is")
      ->check(finite);
  const auto options = std::make_shared<CommandOptions>();
  options->add_to(*verb);
  network->add_to(*verb);
  verb->callback([network, options, place] {
    GroundCommand ground_command;
    ground_command.name = "goto";
    ground_command.go_to = *place;
    options->send(*network, ground_command);
  });
}

void add_claw(CLI::App& gcs, const Network& network) {
  CLI::App* claw = gcs.add_subcommand("claw", "Open or close the gripper");
  claw->require_subcommand(1);
  add_simple(*claw, network, "open", "Let go", command::CLAW_OPEN, "claw ");
  add_simple(*claw, network, "close", "Take hold", command::CLAW_CLOSE, "claw ");
}

void add_status(CLI::App& gcs, const Network& network) {
  const auto options = std::make_shared<StatusOptions>();
  CLI::App* verb = gcs.add_subcommand("status", "What the vehicle is doing");
  verb->add_flag("--json", options->json, "For scripts");
  verb->add_flag("--wait", options->wait, "Until it may be armed; says meanwhile what is missing");
  verb->add_option("--patience", options->patience,
                   fmt::format("For the vehicle's answer [s]; {:g}, with --wait {:g}",
                               to_seconds(StatusClient::kPatience), kReadyPatience))
      ->check(within(0.1, 3600.0));
  network->add_to(*verb);
  verb->callback([network, options] { show_status(*network, *options); });
}

void add_watch(CLI::App& gcs, const Network& network) {
  CLI::App* verb = gcs.add_subcommand("watch", "Its state, a line a second, until Ctrl-C");
  const auto json = std::make_shared<bool>(false);
  verb->add_flag("--json", *json, "For scripts: an object a line");
  network->add_to(*verb);
  verb->callback([network, json] {
    Host host(network->host_options("gcs"));
    host.emplace<Heartbeat>("heartbeat", network->station(), Heartbeat::Absence::kIsMissed);
    host.emplace<StatusClient>("gcs", *json ? to_json_line : one_line);
    host.run();
  });
}

/// All verbs, from the first that has no group yet on, get one in the help.
void group_verbs(CLI::App& gcs, const char* group) {
  for (CLI::App* verb : gcs.get_subcommands({})) {
    if (verb->get_group() == "Subcommands") verb->group(group);
  }
}

/// What all verbs have in common is said once: the help of one shows what is its own.
void shorten_help(CLI::App& group) {
  for (CLI::App* verb : group.get_subcommands({})) {
    if (!verb->get_subcommands({}).empty()) {
      shorten_help(*verb);
      continue;
    }
    for (CLI::Option* option : verb->get_options()) {
      const std::string name = option->get_name();
      if (option->get_group() == "Network" || name == "--qos-profiles") option->group("");
    }
    std::string footer = verb->get_footer();
    if (footer.find("Exit codes") == std::string::npos) {
      footer += (footer.empty() ? "" : "\n\n") + std::string(kExitCodes);
    }
    verb->footer(footer + "\nOptions of the network: swiftlet gcs --help");
  }
}

}  // namespace

void add_gcs_commands(CLI::App& gcs) {
  gcs.require_subcommand(0, 1);
  const auto network = std::make_shared<GroundOptions>();
  add_screen(gcs, network);

  add_simple(gcs, network, "arm", "Let the rotors turn", command::ARM);
  add_takeoff(gcs, network);
  add_goto(gcs, network);
  add_gps(gcs, network);
  add_simple(gcs, network, "hover", "Stop, and hold this place", command::HOVER);
  add_simple(gcs, network, "explore", "Look at all that can be reached, and come back",
             command::EXPLORE);
  add_simple(gcs, network, "return", "Fly back to the take-off point, and land there",
             command::RETURN);
  add_simple(gcs, network, "land", "Descend here until the ground is felt", command::LAND);
  add_simple(gcs, network, "disarm", "Stop the rotors, on the ground", command::DISARM);
  add_mode_verb(gcs, network);
  group_verbs(gcs, "Fly");

  add_simple(gcs, network, "manual",
             "Mode Manual: the sticks fly (swiftlet gcs stick, a remote control)", command::MANUAL);
  add_simple(gcs, network, "assist",
             "Mode Assisted Manual: the sticks fly, and obstacles stop them", command::ASSIST);
  add_stick(gcs, network);
  group_verbs(gcs, "Fly by hand");

  add_follow_verb(gcs, network);
  CLI::App* mission = gcs.add_subcommand("mission", "Missions: files, and what the vehicle has");
  mission->require_subcommand(1);
  add_mission_file_verbs(*mission);
  add_mission_verbs(*mission, network);
  add_waypoint_verbs(gcs, network);
  add_claw(gcs, network);
  group_verbs(gcs, "Fly missions");

  add_status(gcs, network);
  add_watch(gcs, network);
  add_log_verb(gcs, network);
  add_battery_verb(gcs, network);
  add_map_verbs(gcs, network);
  add_cloud_verbs(gcs, network);
  group_verbs(gcs, "Look");

  add_control_verbs(gcs, network);
  add_param_commands(gcs);
  group_verbs(gcs, "Settings");

  shorten_help(gcs);
  gcs.footer(
      "Without a verb: a screen that does all of it by keys (? is help, q quits).\n\n"
      "  swiftlet gcs status --wait && swiftlet gcs arm && swiftlet gcs takeoff 1.2 --wait\n"
      "  swiftlet gcs goto 2.2 4.4 --wait && swiftlet gcs return --wait\n\n" +
      std::string(kExitCodes));
}

}  // namespace swiftlet
