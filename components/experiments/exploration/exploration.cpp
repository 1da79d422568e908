// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/exploration/exploration.hpp"

#include <fmt/format.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "components/experiments/shared_file.hpp"
#include "components/lidar_mapper/map_keeper.hpp"
#include "components/runtime/host.hpp"
#include "components/sim/pilot.hpp"
#include "components/sim/plan_view.hpp"
#include "components/sim/referee.hpp"
#include "components/sim/scenario.hpp"
#include "components/sim/world.hpp"
#include "planner/exploration/explorer.hpp"
#include "planner/exploration/mapped_share.hpp"

namespace swiftlet {
namespace {

constexpr const char* kScenario = "sim/scenarios/house.yaml";

/// One flight through the house.
struct Exploration {
  FlightOutcome outcome;
  FlightRecord record;
  double length = 0.0;       ///< flown [m]
  double mapped = 0.0;       ///< share of what can be reached
  double landing_off = 0.0;  ///< from the centre of the pad [m]
};

/// The world as a perfect map would show it at the height of flight.
OccupancyGrid true_map(const Scenario& scenario) {
  const World world = World::load(scenario.world, scenario.ground_models);
  const Scenario::MapBounds& bounds = scenario.map;
  OccupancyGrid::Params params;
  params.resolution = bounds.resolution;
  const Eigen::Vector2d cells = (bounds.max - bounds.min) / bounds.resolution;
  OccupancyGrid truth(params, bounds.min, static_cast<int>(cells.x()), static_cast<int>(cells.y()));
  for (int y = 0; y < truth.height(); ++y) {
    for (int x = 0; x < truth.width(); ++x) {
      const Eigen::Vector2d middle = truth.center_of({x, y});
      const bool is_solid =
          world
              .nearest({middle.x(), middle.y(), scenario.mission.takeoff_altitude}, 1e-6,
                       World::Surfaces::kObstacles)
              .has_value();
      truth.set_state({x, y}, is_solid ? CellState::kOccupied : CellState::kFree);
    }
  }
  return truth;
}

Result<Exploration> explore(const std::filesystem::path& file, Scenario scenario, int seed,
                            bool rule_of_1997, const OccupancyGrid& truth) {
  scenario.seed = static_cast<std::uint64_t>(seed);
  Config parameters;
  parameters.set("sim.scenario", file.string());
  parameters.set("sim.seed", std::to_string(seed));
  parameters.set("planner.seed", std::to_string(seed));
  if (rule_of_1997) parameters.set("explorer.rule_of_1997", "true");
  HostOptions options;
  options.participant.name = "experiment";
  options.lockstep = true;
  Host host(options);
  for (const std::string& name : components_of(scenario)) host.add(name, parameters.child(name));
  const auto& pilot = host.emplace<Pilot>("pilot", scenario);
  const auto& referee = host.emplace<Referee>("referee");
  const auto& map = host.emplace<MapKeeper>("map_keeper");
  (void)host.run();  // what the flight was worth says the pilot
  Exploration result{pilot.outcome(), referee.record(), 0.0, 0.0, 0.0};
  if (!result.outcome.finished) return Error{"ended by the error above, or by a signal"};
  const Eigen::Vector2d start(scenario.start.x, scenario.start.y);
  result.length = length_flown(result.record);
  result.landing_off = (result.record.final_position.head<2>() - start).norm();
  if (const auto grid = map.latest()) {
    result.mapped = mapped_share(truth, *grid, start, Explorer::Params().clearance);
  }
  return result;
}

Status draw(const Scenario& scenario, const Exploration& flight, const std::string& order,
            const std::filesystem::path& file) {
  PlanView view;
  view.title = fmt::format("{}: {}", scenario.name, order);
  view.subtitle =
      fmt::format("{:.0f} m, {:.0f} s, {:.1f} % mapped: {}", flight.length,
                  flight.outcome.flight_time, 100.0 * flight.mapped, flight.outcome.reason);
  const World world = World::load(scenario.world, scenario.ground_models);
  view.outlines = world.slice(scenario.mission.takeoff_altitude);
  view.flown = flight.record.flown;
  view.flown_speed = flight.record.flown_speed;
  view.pad = {scenario.start.x, scenario.start.y};
  return draw_plan_view(view, file);
}

using Quantity = std::function<double(const Exploration&)>;

ExperimentRow row_of(std::string quantity, std::string unit,
                     const std::vector<Exploration>& flights, const Quantity& value) {
  ExperimentRow row;
  row.quantity = std::move(quantity);
  row.unit = std::move(unit);
  for (const Exploration& flight : flights) row.values.push_back(value(flight));
  return row;
}

double was_flown(const Exploration& flight) {
  return flight.outcome.success ? 1.0 : 0.0;
}
double length(const Exploration& flight) {
  return flight.length;
}
double duration(const Exploration& flight) {
  return flight.outcome.flight_time;
}

/// Ours beside the rule of 1997, and the share that ours is of it, seed by seed.
void compare(const std::string& quantity, const std::string& unit,
             const std::vector<Exploration>& ours, const std::vector<Exploration>& peers,
             const Quantity& value, std::vector<ExperimentRow>& rows) {
  constexpr double kMostOfPeer = 0.85;
  const ExperimentRow peer = row_of("rule of 1997: " + quantity, unit, peers, value);
  ExperimentRow row = row_of(quantity, unit, ours, value);
  row.reference = peer.median();
  row.source = "rule of 1997, median";
  ExperimentRow share;
  share.quantity = quantity + ", share of the rule of 1997's";
  for (std::size_t i = 0; i < row.values.size(); ++i) {
    share.values.push_back(row.values[i] / peer.values[i]);
  }
  share.goal = kMostOfPeer;
  share.goal_is_of_median = true;
  rows.insert(rows.end(), {row, share, peer});
}

std::vector<ExperimentRow> table(const std::vector<Exploration>& ours,
                                 const std::vector<Exploration>& peers) {
  std::vector<ExperimentRow> rows;
  const auto add = [&](const char* quantity, const char* unit, const Quantity& value,
                       std::optional<double> goal, bool more_is_better) {
    ExperimentRow& row = rows.emplace_back(row_of(quantity, unit, ours, value));
    row.goal = goal;
    row.more_is_better = more_is_better;
  };
  add("explored, returned and landed", "", was_flown, 1.0, true);
  add(
      "share mapped of what can be reached", "",
      [](const Exploration& flight) { return flight.mapped; }, 0.99, true);
  add(
      "contacts", "", [](const Exploration& flight) { return flight.record.contacts; }, 0.0, false);
  add(
      "least distance of the hull to anything", "m",
      [](const Exploration& flight) { return flight.record.min_clearance; }, {}, true);
  add(
      "landing off the centre of the pad", "m",
      [](const Exploration& flight) { return flight.landing_off; }, {}, false);
  compare("length flown", "m", ours, peers, length, rows);
  compare("time from arming to disarming", "s", ours, peers, duration, rows);
  ExperimentRow& mapped =
      rows.emplace_back(row_of("rule of 1997: share mapped", "", peers,
                               [](const Exploration& flight) { return flight.mapped; }));
  mapped.more_is_better = true;
  ExperimentRow& flown = rows.emplace_back(
      row_of("rule of 1997: explored, returned and landed", "", peers, was_flown));
  flown.more_is_better = true;
  return rows;
}

}  // namespace

Result<ExperimentResult> run_exploration(const ExperimentOptions& options) {
  const std::filesystem::path file = shared_file(kScenario);
  const Scenario scenario = Scenario::load(file);
  const OccupancyGrid truth = true_map(scenario);
  std::vector<Exploration> flights[2];  // ours, and the rule of 1997
  int done = 0;
  for (int seed = 1; seed <= options.seeds; ++seed) {
    for (const bool rule_of_1997 : {false, true}) {
      options.progress(done++, 2 * options.seeds);
      auto flight = explore(file, scenario, seed, rule_of_1997, truth);
      if (!flight.ok()) return Error{fmt::format("seed {}: {}", seed, flight.error().reason)};
      flights[rule_of_1997 ? 1 : 0].push_back(std::move(*flight));
    }
  }
  options.progress(done, done);
  ExperimentResult result{"exploration", options.seeds, table(flights[0], flights[1])};
  if (options.report.empty()) return result;
  Status drawn =
      draw(scenario, flights[0].front(), "our explorer", options.report / "exploration.png");
  if (drawn.ok()) {
    drawn = draw(scenario, flights[1].front(), "the rule of 1997",
                 options.report / "exploration-nearest.png");
  }
  if (!drawn.ok()) return drawn.error();
  return result;
}

}  // namespace swiftlet
