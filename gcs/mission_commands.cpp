// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/mission_commands.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "components/commander/mission_message.hpp"
#include "components/terminal/terminal.hpp"
#include "gcs/command_options.hpp"
#include "gcs/mission/mission_check.hpp"
#include "gcs/mission/mission_file.hpp"
#include "gcs/mission_clients.hpp"
#include "gcs/number_check.hpp"

namespace swiftlet {
namespace {

namespace command = swiftlet_msgs::msg::ModeCommand_Constants;

using Network = std::shared_ptr<NetworkOptions>;

constexpr int kFailed = 1;
constexpr int kUnusable = 2;

[[noreturn]] void end(int code, const std::string& reason) {
  fmt::print(stderr, "error: {}\n", reason);
  throw CLI::RuntimeError(code);
}

/// How far a transfer is, in the terminal's status line.
TellProgress on_terminal(Terminal& terminal, const char* what) {
  return [&terminal, what](const TransferProgress& progress) {
    terminal.show(progress.count == 0
                      ? fmt::format("{}: looking for the vehicle", what)
                      : fmt::format("{}: {} of {} items", what, progress.done, progress.count));
  };
}

TransferParams with_patience(double seconds) {
  TransferParams params;
  params.patience = from_seconds(seconds);
  return params;
}

void add_patience(CLI::App& verb, double& patience) {
  verb.add_option("--patience", patience, "Without any headway, before it gives up [s]")
      ->capture_default_str()
      ->check(within(0.5, 600.0));
}

/// Items of a file that was found to be flyable, wherever the vehicle is.
MissionInbox::Items flyable_items(const std::string& file) {
  const Result<MissionFile> mission = read_mission(file);
  if (!mission.ok()) end(kUnusable, mission.error().reason);
  for (const MissionRemark& remark : mission->remarks) {
    fmt::print(stderr, "{}:{}: note: {}\n", file, remark.line, remark.text);
  }
  MissionCheckParams params;
  params.on_ground = false;  // that is not known here; the vehicle refuses what it cannot fly
  const MissionCheck check = check_mission(*mission, params);
  for (const MissionFinding& finding : check.findings) {
    fmt::print(stderr, "{}\n", describe(finding, file));
  }
  if (check.has_errors()) end(kUnusable, "the mission was not sent");
  MissionInbox::Items items;
  for (const MissionItem& item : items_of(*mission)) items.push_back(to_msg(item));
  return items;
}

void upload(const NetworkOptions& network, const std::string& file, double patience) {
  MissionInbox::Items items = flyable_items(file);
  Terminal terminal;
  Host host(network.host_options("gcs"));
  const Time now(std::chrono::system_clock::now().time_since_epoch());
  const std::string id = fmt::format("gcs-{}-{}", getpid(), now.time_since_epoch().count());
  const std::size_t count = items.size();
  const auto& client = host.emplace<UploadClient>(
      "gcs", id, std::move(items), with_patience(patience), on_terminal(terminal, "upload"));
  const int code = host.run();
  terminal.clear();
  if (code == 0 && client.progress().state == TransferProgress::State::kDone) {
    fmt::print("upload: {} items, read back\n", count);
    return;
  }
  const std::string& reason = client.progress().reason;
  end(kFailed, reason.empty() ? "interrupted; the vehicle has the mission as a whole or not at all"
                              : reason);
}

void download(const NetworkOptions& network, const std::string& file, double patience) {
  if (const auto form = mission_form_of(file); !form.ok()) end(kUnusable, form.error().reason);
  Terminal terminal;
  Host host(network.host_options("gcs"));
  const auto& client = host.emplace<DownloadClient>("gcs", with_patience(patience),
                                                    on_terminal(terminal, "download"));
  host.run();
  terminal.clear();
  const MissionDownload& download = client.download();
  if (download.progress().state != TransferProgress::State::kDone) {
    const std::string& reason = download.progress().reason;
    end(kFailed, reason.empty() ? "interrupted" : reason);
  }
  MissionFile mission;
  for (const auto& message : download.items()) {
    const auto item = from_msg(message);
    if (!item.ok()) end(kFailed, item.error().reason);
    mission.items.push_back({*item, 0});
  }
  const auto written = write_mission(file, mission);
  if (!written.ok()) end(kFailed, written.error().reason);
  for (const MissionRemark& loss : *written) fmt::print(stderr, "{}: note: {}\n", file, loss.text);
  fmt::print("{}: {} items\n", file, mission.items.size());
}

void show_state(const NetworkOptions& network, bool as_json) {
  Host host(network.host_options("gcs"));
  const auto& client = host.emplace<MissionStateClient>("gcs", std::chrono::milliseconds(1800));
  host.run();
  if (!client.state()) {
    end(kFailed, fmt::format("no vehicle says what mission it has in domain {}; does a commander "
                             "run there, and is --vehicle right?",
                             host.domain()));
  }
  const auto& state = *client.state();
  const std::string name = mission_state_name(state.state());
  if (as_json) {
    const nlohmann::json json = {{"state", name},
                                 {"id", state.id()},
                                 {"items", state.count()},
                                 {"item", state.item()},
                                 {"reason", state.reason()}};
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("mission   {}", name);
  if (state.count() > 0) fmt::print(", {} items", state.count());
  if (state.item() > 0) fmt::print(", at item {}", state.item());
  fmt::print("\n");
  if (!state.reason().empty()) fmt::print("reason    {}\n", state.reason());
}

void add_transfers(CLI::App& mission, const Network& network) {
  struct Options {
    std::string file;
    double patience = 20.0;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* up = mission.add_subcommand(
      "upload", "Check a mission file, bring it to the vehicle, and read it back");
  up->add_option("file", options->file, "MISSION.yaml, .plan or .waypoints")->required();
  add_patience(*up, options->patience);
  network->add_to(*up);
  up->callback([network, options] { upload(*network, options->file, options->patience); });

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
        ->check(CLI::PositiveNumber);
  }
  options->add_to(*verb);
  network->add_to(*verb);
  verb->callback([network, options, order] { options->send(*network, *order); });
}

}  // namespace

void add_mission_commands(CLI::App& mission, const Network& network) {
  add_transfers(mission, network);
  const auto json = std::make_shared<bool>(false);
  CLI::App* status =
      mission.add_subcommand("status", "What mission the vehicle has, and where it is in it");
  status->add_flag("--json", *json, "For scripts");
  network->add_to(*status);
  status->callback([network, json] { show_state(*network, *json); });
  add_order(mission, network, "start", "Fly it, or go on where it was paused",
            command::MISSION_START);
  add_order(mission, network, "pause", "Hover, and keep the place in it", command::MISSION_PAUSE);
  add_order(mission, network, "clear", "Forget it", command::MISSION_CLEAR);
}

}  // namespace swiftlet
