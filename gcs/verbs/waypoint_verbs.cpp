// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>
#include <utility>

#include "components/runtime/number_check.hpp"
#include "gcs/mission/degrees.hpp"
#include "gcs/mission/mission_edit.hpp"
#include "gcs/mission/mission_text.hpp"
#include "gcs/verbs/mission_exchange.hpp"
#include "gcs/verbs/verb_end.hpp"
#include "gcs/verbs/verbs.hpp"

namespace swiftlet {
namespace {

using Network = std::shared_ptr<GroundOptions>;

/// What the verbs take; each has its own.
struct Options {
  double x = 0.0, y = 0.0, z = 0.0;
  bool gps = false;
  std::optional<double> yaw_deg, speed, hold;
  std::optional<std::size_t> at;
  std::size_t number = 0;
  bool json = false;
  double patience = kTransferPatience;
};

MissionItem waypoint_of(const Options& options) {
  MissionItem item;
  if (options.gps) {
    item.global = GlobalWaypoint{options.x, options.y, options.z};
  } else {
    item.place.position = {options.x, options.y, options.z};
  }
  if (options.yaw_deg) item.place.yaw = from_degrees(*options.yaw_deg);
  item.place.speed = options.speed;
  item.hold = options.hold.value_or(0.0);
  return item;
}

void print(const MissionFile& mission, bool json) {
  const std::vector<MissionItem> items = items_of(mission);
  if (json) {
    fmt::print("{}\n", mission_json(items));
  } else {
    fmt::print("{}", items.empty() ? "the vehicle has no mission\n" : mission_table(items));
  }
}

/// Fetches the mission, changes it, and brings it back as a whole.
template <class Edit>
MissionFile changed_mission(const GroundOptions& network, const Options& options, Edit change) {
  const GroundStation station = network.enter();
  const MissionFile before = fetch_mission(station, options.patience);
  std::vector<MissionItem> items = items_of(before);
  const Status changed = change(items);
  if (!changed.ok()) end_verb(kExitUnusable, changed.error().reason);
  if (items.empty()) {
    end_verb(kExitUnusable,
             "it is the only item, and a mission without any cannot be sent; to forget the "
             "mission: swiftlet gcs mission clear");
  }
  MissionFile mission;
  for (MissionItem& item : items) mission.items.push_back({std::move(item), 0});
  const char* name = "the mission";
  refuse_unflyable(mission, name, &before);
  const UploadPlan plan{MissionBegin::kLater, options.patience, &before};
  send_mission(station, flyable_items(station, mission, name, plan), options.patience);
  return mission;
}

template <class Edit>
void edit(const GroundOptions& network, const Options& options, Edit change) {
  print(changed_mission(network, options, change), options.json);
}

void add(const GroundOptions& network, const Options& options) {
  edit(network, options, [&options](std::vector<MissionItem>& items) -> Status {
    const auto added = add_waypoint(items, waypoint_of(options), options.at);
    if (added.ok()) return {};
    return added.error();
  });
}

void move(const GroundOptions& network, const Options& options) {
  edit(network, options, [&options](std::vector<MissionItem>& items) {
    return move_waypoint(items, options.number, waypoint_of(options));
  });
}

void remove(const GroundOptions& network, const Options& options) {
  edit(network, options,
       [&options](std::vector<MissionItem>& items) { return remove_item(items, options.number); });
}

void list(const GroundOptions& network, const Options& options) {
  const MissionFile mission = fetch_mission(network.enter(), options.patience);
  print(mission, options.json);
}

struct Verb {
  CLI::App* app;
  std::shared_ptr<Options> options;
};

Verb add_verb(CLI::App& group, const Network& network, const char* name, const char* what,
              void (*run)(const GroundOptions&, const Options&)) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = group.add_subcommand(name, what);
  verb->callback([network, options, run] { run(*network, *options); });
  return {verb, options};
}

void add_number(const Verb& verb) {
  verb.app->add_option("number", verb.options->number, "Of the item, from 1; see: waypoint list")
      ->required()
      ->check(whole_within(1, 1'000'000));
}

void add_place(const Verb& verb) {
  Options& options = *verb.options;
  const auto finite = within(-1e6, 1e6);
  verb.app->add_option("x", options.x, "In the map [m]; with --gps latitude [deg]")
      ->required()
      ->check(finite);
  verb.app->add_option("y", options.y, "In the map [m]; with --gps longitude [deg]")
      ->required()
      ->check(finite);
  verb.app
      ->add_option("z", options.z, "In the map [m]; with --gps altitude above the take-off point")
      ->required()
      ->check(finite);
  verb.app->add_flag("--gps", options.gps, "A place on Earth rather than in the map");
  verb.app->add_option("--yaw", options.yaw_deg, "Counter-clockwise from east [deg]")
      ->check(within(-360.0, 360.0));
  verb.app->add_option("--hold", options.hold, "Stay there [s]")->check(within(0.0, 3600.0));
  verb.app->add_option("--speed", options.speed, "With --gps: the greatest on the way [m/s]")
      ->check(within(0.1, 50.0));
}

void add_common(const Verb& verb, const Network& network) {
  verb.app->add_flag("--json", verb.options->json, "For scripts: the items");
  add_patience(*verb.app, verb.options->patience);
  network->add_to(*verb.app);
}

}  // namespace

void add_waypoint_verbs(CLI::App& gcs, const Network& network) {
  CLI::App* group = gcs.add_subcommand("waypoint", "Look at the vehicle's mission, and change it");
  group->require_subcommand(1);
  group->footer(
      "A change fetches the mission, checks it as mission upload does, and brings it back as a "
      "whole;\nthe vehicle refuses it while it flies the mission.");

  add_common(add_verb(*group, network, "list", "Its items, numbered from 1", list), network);

  const Verb added =
      add_verb(*group, network, "add",
               "A waypoint at the end, but before a landing or a return that ends it", add);
  add_place(added);
  added.app->add_option("--at", added.options->at, "Its number; those from there on come after it")
      ->check(whole_within(1, 1'000'000));
  add_common(added, network);

  const Verb moved = add_verb(*group, network, "move", "Put a waypoint elsewhere", move);
  add_number(moved);
  add_place(moved);
  add_common(moved, network);

  const Verb removed = add_verb(*group, network, "remove", "Take an item out", remove);
  add_number(removed);
  add_common(removed, network);
}

}  // namespace swiftlet
