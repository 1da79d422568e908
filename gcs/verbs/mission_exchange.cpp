// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/mission_exchange.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <utility>

#include "components/commander/mission_message.hpp"
#include "components/terminal/terminal.hpp"
#include "gcs/mission/mission_check.hpp"
#include "gcs/transfer/mission_clients.hpp"
#include "gcs/verbs/number_check.hpp"
#include "gcs/verbs/outlook_client.hpp"
#include "gcs/verbs/verb_end.hpp"

namespace swiftlet {
namespace {

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

}  // namespace

void add_patience(CLI::App& verb, double& patience_s) {
  verb.add_option("--patience", patience_s, "Without any headway, before it gives up [s]")
      ->capture_default_str()
      ->check(within(0.5, 600.0));
}

MissionFile mission_of_file(const std::string& file) {
  Result<MissionFile> mission = read_mission(file);
  if (!mission.ok()) end_verb(kExitUnusable, mission.error().reason);
  for (const MissionRemark& remark : mission->remarks) {
    fmt::print(stderr, "{}:{}: note: {}\n", file, remark.line, remark.text);
  }
  return std::move(*mission);
}

MissionInbox::Items flyable_items(const NetworkOptions& network, const MissionFile& mission,
                                  const std::string& name, MissionBegin begin) {
  Host host(network.host_options("gcs"));
  const auto& client = host.emplace<OutlookClient>("gcs");
  host.run();
  const screen::Circumstances circumstances = client.circumstances();
  MissionCheckParams params = circumstances.check;
  if (begin == MissionBegin::kLater) params.on_ground = false;  // who knows what comes before
  const OccupancyGrid map = circumstances.map ? known_map(*circumstances.map) : OccupancyGrid();
  params.map = &map;
  const MissionCheck check = check_mission(mission, params);
  for (const MissionFinding& finding : check.findings) {
    fmt::print(stderr, "{}\n", describe(finding, name));
  }
  if (const auto unknown = client.unknown(); !unknown.empty()) {
    fmt::print(stderr, "{}: note: not known of the vehicle, and not checked: {}\n", name,
               fmt::join(unknown, ", "));
  }
  if (check.has_errors()) end_verb(kExitUnusable, "the mission was not sent");
  MissionInbox::Items items;
  for (const MissionItem& item : items_of(mission)) items.push_back(to_msg(item));
  return items;
}

void send_mission(const NetworkOptions& network, MissionInbox::Items items, double patience_s) {
  Terminal terminal;
  Host host(network.host_options("gcs"));
  const Time now(std::chrono::system_clock::now().time_since_epoch());
  const std::string id = fmt::format("gcs-{}-{}", getpid(), now.time_since_epoch().count());
  const auto& client = host.emplace<UploadClient>(
      "gcs", id, std::move(items), with_patience(patience_s), on_terminal(terminal, "upload"));
  const int code = host.run();
  terminal.clear();
  if (code == 0 && client.progress().state == TransferProgress::State::kDone) return;
  const std::string& reason = client.progress().reason;
  end_verb(kExitFailed, reason.empty()
                            ? "interrupted; the vehicle has the mission as a whole or not at all"
                            : reason);
}

MissionFile fetch_mission(const NetworkOptions& network, double patience_s) {
  Terminal terminal;
  Host host(network.host_options("gcs"));
  const auto& client = host.emplace<DownloadClient>("gcs", with_patience(patience_s),
                                                    on_terminal(terminal, "download"));
  host.run();
  terminal.clear();
  const MissionDownload& download = client.download();
  MissionFile mission;
  if (download.nothing_there()) return mission;
  if (download.progress().state != TransferProgress::State::kDone) {
    const std::string& reason = download.progress().reason;
    end_verb(kExitFailed, reason.empty() ? "interrupted" : reason);
  }
  for (const auto& message : download.items()) {
    const auto item = from_msg(message);
    if (!item.ok()) end_verb(kExitFailed, item.error().reason);
    mission.items.push_back({*item, 0});
  }
  return mission;
}

}  // namespace swiftlet
