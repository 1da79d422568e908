// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "components/command_name.hpp"
#include "components/mode_message.hpp"
#include "components/runtime/number_check.hpp"
#include "components/topics.hpp"
#include "gcs/verbs/command_options.hpp"
#include "gcs/verbs/first_message.hpp"
#include "gcs/verbs/mode_names.hpp"
#include "gcs/verbs/verb_end.hpp"
#include "gcs/verbs/verbs.hpp"

namespace swiftlet {
namespace {

struct Options {
  std::vector<std::string> words;
  double altitude = kUsualAltitude;
  CommandOptions command;
};

std::string text_of(const swiftlet_msgs::msg::VehicleStatus& status) {
  const std::string why = status.reason().empty() ? "" : ": " + status.reason();
  return fmt::format("{}{}\n", mode_name(status.mode()), why);
}

std::string json_of(const swiftlet_msgs::msg::VehicleStatus& status) {
  const nlohmann::json json = {{"mode", mode_name(status.mode())},
                               {"armed", status.armed()},
                               {"ready", status.ready()},
                               {"reason", status.reason()}};
  return json.dump(2) + "\n";
}

void show(const GroundOptions& network, const CommandOptions& options) {
  Host host(network.host_options("gcs"));
  const auto& client = host.emplace<FirstMessage<swiftlet_msgs::msg::VehicleStatus>>(
      "gcs", topic::vehicle_status, from_seconds(options.patience()));
  host.run();
  if (!client.message()) end_verb(kExitFailed, nobody_answers(host.domain()));
  fmt::print("{}", options.json() ? json_of(*client.message()) : text_of(*client.message()));
}

void run(const GroundOptions& network, const Options& options) {
  if (options.words.empty()) return show(network, options.command);
  const auto code = command_of_mode(fmt::format("{}", fmt::join(options.words, " ")));
  if (!code.ok()) end_verb(kExitUnusable, code.error().reason);
  GroundCommand command;
  command.name = command_name(*code);
  command.command = *code;
  command.altitude = options.altitude;
  options.command.send(network, command);
}

}  // namespace

void add_mode_verb(CLI::App& gcs, const std::shared_ptr<GroundOptions>& network) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = gcs.add_subcommand("mode", "What mode it is in, and why; or change it");
  verb->add_option("name", options->words,
                   "Takeoff, Hover, Land, Manual, Assisted Manual, Indoor Exploration, or a verb's "
                   "name: assist, explore, return; without, it says the mode");
  verb->add_option("--altitude", options->altitude, "Of Takeoff, above the take-off point [m]")
      ->capture_default_str()
      ->check(within(0.0, 1e4));
  verb->footer(
      "The same as the verb of that name. GPS Guidance and Indoor Navigation need a place: gps, "
      "goto.");
  options->command.add_to(*verb);
  network->add_to(*verb);
  verb->callback([network, options] { run(*network, *options); });
}

}  // namespace swiftlet
