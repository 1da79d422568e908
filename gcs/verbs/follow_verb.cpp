// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

#include "gcs/verbs/command_options.hpp"
#include "gcs/verbs/mission_exchange.hpp"
#include "gcs/verbs/verbs.hpp"

namespace swiftlet {
namespace {

struct Options {
  std::string file;
  CommandOptions command;
};

void follow(const GroundOptions& network, const Options& options) {
  const double patience = std::max(kTransferPatience, options.command.patience());
  const MissionFile mission = mission_of_file(options.file);
  refuse_unflyable(mission, options.file);
  const GroundStation station = network.enter();
  MissionInbox::Items items =
      flyable_items(station, mission, options.file, {MissionBegin::kNow, patience, nullptr});
  send_mission(station, std::move(items), patience);
  GroundCommand start;
  start.name = "follow";
  start.command = swiftlet_msgs::msg::ModeCommand_Constants::MISSION_START;
  start.item = 1;  // it is a new one, and there is no place in it to go on from
  options.command.send(station, start);
}

}  // namespace

void add_follow_verb(CLI::App& gcs, const std::shared_ptr<GroundOptions>& network) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = gcs.add_subcommand(
      "follow", "Fly a mission file: check it, bring it to the vehicle, start it");
  verb->add_option("file", options->file, "MISSION.yaml, .plan or .waypoints")->required();
  verb->footer(
      "The vehicle must be armed: swiftlet gcs arm. The same in steps: mission validate, mission "
      "upload, mission start.\nExit codes: 0 it flies (with --wait: it is done), 1 refused or come "
      "to another end, 2 the file cannot be used.");
  options->command.add_to(*verb);
  network->add_to(*verb);
  verb->callback([network, options] { follow(*network, *options); });
}

}  // namespace swiftlet
