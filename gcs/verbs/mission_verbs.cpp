// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/mission_verbs.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "components/mission_state_name.hpp"
#include "components/runtime/number_check.hpp"
#include "components/topics.hpp"
#include "estimation/basics/whole_file.hpp"
#include "gcs/mission/mission_file.hpp"
#include "gcs/verbs/command_options.hpp"
#include "gcs/verbs/first_message.hpp"
#include "gcs/verbs/mission_exchange.hpp"
#include "gcs/verbs/verb_end.hpp"

namespace swiftlet {
namespace {

namespace command = swiftlet_msgs::msg::ModeCommand_Constants;

using Network = std::shared_ptr<GroundOptions>;

void upload(const GroundOptions& network, const std::string& file, MissionBegin begin,
            double patience) {
  const MissionFile mission = mission_of_file(file);
  refuse_unflyable(mission, file);
  const GroundStation station = network.enter();
  MissionInbox::Items items = flyable_items(station, mission, file, {begin, patience, nullptr});
  const std::size_t count = items.size();
  send_mission(station, std::move(items), patience);
  fmt::print("upload: {} items, read back\n", count);
}

void download(const GroundOptions& network, const std::string& file, double patience) {
  if (const auto form = mission_form_of(file); !form.ok()) {
    end_verb(kExitUnusable, form.error().reason);
  }
  if (const Status place = check_writable(file); !place.ok()) {
    end_verb(kExitUnusable, place.error().reason);
  }
  const MissionFile mission = fetch_mission(network.enter(), patience);
  if (mission.items.empty()) end_verb(kExitFailed, "the vehicle has no mission");
  const auto written = write_mission(file, mission);
  if (!written.ok()) end_verb(kExitFailed, written.error().reason);
  for (const MissionRemark& loss : *written) fmt::print(stderr, "{}: note: {}\n", file, loss.text);
  fmt::print("{}: {} items\n", file, mission.items.size());
}

void show_state(const GroundOptions& network, bool as_json) {
  Host host(network.host_options("gcs"));
  const auto& client = host.emplace<FirstMessage<swiftlet_msgs::msg::MissionState>>(
      "gcs", topic::mission_state, std::chrono::milliseconds(1800));
  host.run();
  if (!client.message()) {
    end_verb(kExitFailed,
             fmt::format("no vehicle says what mission it has in domain {}; does a commander "
                         "run there, and is --vehicle right?",
                         host.domain()));
  }
  const auto& state = *client.message();
  if (as_json) {
    const nlohmann::json json = {{"state", mission_state_name(state.state())},
                                 {"id", state.id()},
                                 {"items", state.count()},
                                 {"item", state.item()},
                                 {"reason", state.reason()}};
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("mission   {}\n", mission_state_text(state));
}

void add_transfers(CLI::App& mission, const Network& network) {
  struct Options {
    std::string file;
    double patience = kTransferPatience;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* up = mission.add_subcommand(
      "upload", "Check a mission file, bring it to the vehicle, and read it back");
  up->add_option("file", options->file, "MISSION.yaml, .plan or .waypoints")->required();
  add_patience(*up, options->patience);
  network->add_to(*up);
  const auto elsewhere = std::make_shared<bool>(false);
  up->add_flag("--elsewhere", *elsewhere,
               "It will not begin where the vehicle is now: what depends on that is not checked");
  up->callback([network, options, elsewhere] {
    const MissionBegin begin = *elsewhere ? MissionBegin::kElsewhere : MissionBegin::kLater;
    upload(*network, options->file, begin, options->patience);
  });

  CLI::App* down = mission.add_subcommand("download", "Write the vehicle's mission into a file");
  down->add_option("file", options->file, "MISSION.yaml, .plan or .waypoints; it is replaced")
      ->required();
  add_patience(*down, options->patience);
  network->add_to(*down);
  down->callback([network, options] { download(*network, options->file, options->patience); });
}

void add_order(CLI::App& mission, const Network& network, const std::string& name, const char* what,
               std::uint8_t code) {
  const auto options = std::make_shared<CommandOptions>();
  const auto order = std::make_shared<GroundCommand>();
  order->name = "mission " + name;
  order->command = code;
  CLI::App* verb = mission.add_subcommand(name, what);
  if (code == command::MISSION_START) {
    verb->add_option("--item", order->item, "To begin with, from 1; else where it was paused")
        ->check(whole_within(1, 1'000'000));
  }
  options->add_to(*verb);
  network->add_to(*verb);
  verb->callback([network, options, order] { options->send(*network, *order); });
}

}  // namespace

void add_mission_verbs(CLI::App& mission, const Network& network) {
  add_transfers(mission, network);
  const auto json = std::make_shared<bool>(false);
  CLI::App* status =
      mission.add_subcommand("status", "What mission the vehicle has, and where it is in it");
  status->add_flag("--json", *json, "For scripts");
  network->add_to(*status);
  status->callback([network, json] { show_state(*network, *json); });
  add_order(mission, network, "start", "Fly it, or go on where it was paused",
            command::MISSION_START);
  add_order(mission, network, "pause", "Hover, and keep the place in it; start goes on from there",
            command::MISSION_PAUSE);
  add_order(mission, network, "clear", "Forget it", command::MISSION_CLEAR);
}

}  // namespace swiftlet
