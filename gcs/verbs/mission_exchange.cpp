// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/mission_exchange.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include "components/commander/mission_message.hpp"
#include "components/runtime/number_check.hpp"
#include "components/terminal/terminal.hpp"
#include "gcs/mission/mission_check.hpp"
#include "gcs/transfer/mission_clients.hpp"
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

constexpr const char* kNotSent = "the mission was not sent";

void refuse_errors(const MissionCheck& check, const std::string& name, int code) {
  if (!check.has_errors()) return;
  for (const MissionFinding& finding : check.findings) {
    fmt::print(stderr, "{}\n", describe(finding, name));
  }
  end_verb(code, kNotSent);
}

/// What a mission is checked by.
struct Outlook {
  MissionCheckParams params;
  std::vector<std::string> unknown;
  std::unique_ptr<OccupancyGrid> map;  // that the parameters point to
};

bool begins_with_takeoff(const MissionFile& mission) {
  for (const WrittenItem& written : mission.items) {
    if (written.item.kind != MissionItem::Kind::kClaw) {
      return written.item.kind == MissionItem::Kind::kTakeoff;
    }
  }
  return false;
}

Outlook look_out(const GroundStation& station, const MissionFile& mission, const UploadPlan& plan) {
  const bool on_earth =
      std::any_of(mission.items.begin(), mission.items.end(),
                  [](const WrittenItem& written) { return written.item.global.has_value(); });
  Host host(station.host);
  const auto& client = host.emplace<OutlookClient>("gcs", from_seconds(plan.patience), on_earth);
  Terminal terminal;
  terminal.show("looking for the vehicle");
  host.run();
  terminal.clear();
  if (!client.circumstances()) end_verb(kExitFailed, "interrupted; " + std::string(kNotSent));
  if (!client.is_heard()) end_verb(kExitFailed, nobody_answers(host.domain()));
  const screen::Circumstances& seen = *client.circumstances();
  Outlook outlook{seen.check, seen.unknown, nullptr};
  if (seen.map) {
    outlook.map = std::make_unique<OccupancyGrid>(known_map(*seen.map));
    outlook.params.map = outlook.map.get();
  }
  if (plan.begin != MissionBegin::kNow) {
    outlook.params.on_ground = begins_with_takeoff(mission);
    outlook.params.start.reset();
    outlook.params.charge = 1.0;  // it will have another battery perhaps
  }
  if (plan.begin == MissionBegin::kElsewhere) {
    outlook.params.takeoff = MissionCheckParams().takeoff;
    outlook.params.origin.reset();
    outlook.params.fence.radius = 0.0;
    outlook.params.map = nullptr;
    outlook.unknown = {"the place from which it will be flown"};
  }
  return outlook;
}

MissionCheck check(const MissionFile& mission, const MissionFile* in_place_of,
                   const MissionCheckParams& params) {
  return in_place_of == nullptr ? check_mission(mission, params)
                                : check_change(*in_place_of, mission, params);
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

void refuse_unflyable(const MissionFile& mission, const std::string& name,
                      const MissionFile* in_place_of) {
  MissionCheckParams anywhere;
  anywhere.on_ground = false;
  refuse_errors(check(mission, in_place_of, anywhere), name, kExitUnusable);
}

MissionInbox::Items flyable_items(const GroundStation& station, const MissionFile& mission,
                                  const std::string& name, const UploadPlan& plan) {
  Outlook outlook = look_out(station, mission, plan);
  const MissionCheck found = check(mission, plan.in_place_of, outlook.params);
  for (const MissionFinding& finding : found.findings) {
    fmt::print(stderr, "{}\n", describe(finding, name));
  }
  if (!outlook.unknown.empty()) {
    fmt::print(stderr, "{}: note: not known of the vehicle, and not checked: {}\n", name,
               fmt::join(outlook.unknown, ", "));
  }
  if (found.has_errors()) end_verb(kExitFailed, kNotSent);
  MissionInbox::Items items;
  for (const MissionItem& item : items_of(mission)) items.push_back(to_msg(item));
  return items;
}

void send_mission(const GroundStation& station, MissionInbox::Items items, double patience_s) {
  Terminal terminal;
  Host host(station.host);
  const Time now(std::chrono::system_clock::now().time_since_epoch());
  const std::string id = fmt::format("gcs-{}-{}", getpid(), now.time_since_epoch().count());
  const auto& client =
      host.emplace<UploadClient>("gcs", station.name, id, std::move(items),
                                 with_patience(patience_s), on_terminal(terminal, "upload"));
  const int code = host.run();
  terminal.clear();
  if (code == 0 && client.progress().state == TransferProgress::State::kDone) return;
  const std::string& reason = client.progress().reason;
  end_verb(kExitFailed, reason.empty()
                            ? "interrupted; the vehicle has the mission as a whole or not at all"
                            : reason);
}

MissionFile fetch_mission(const GroundStation& station, double patience_s) {
  Terminal terminal;
  Host host(station.host);
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
