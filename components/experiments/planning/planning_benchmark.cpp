// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/planning/planning_benchmark.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "components/experiments/planning/collision_peer.hpp"
#include "components/experiments/planning/map_figure.hpp"
#include "components/experiments/planning/map_files.hpp"
#include "components/experiments/planning/ompl_peers.hpp"
#include "components/experiments/planning/proof.hpp"
#include "planner/any_angle/any_angle_planner.hpp"

namespace swiftlet {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t kProblems = 100;  // of each map
constexpr std::size_t kDrawn = 5;       // of them
constexpr double kPlaneLimit_s = 0.050, kSpaceLimit_s = 0.200;
constexpr double kPlaneGoal = 0.955, kSpaceGoal = 0.97;  // of the octile length
constexpr double kFirstGoal_ms = 3.0;
constexpr double kBallRadius = 1.5;  // [voxels]
constexpr int kChecks = 100'000;
constexpr double kChecksGoal = 60.0;  // times the peer's
constexpr std::uint32_t kSeed = 1;

/// How one planner did on the problems of a map.
struct Score {
  std::vector<double> ratios;  ///< of solved ones, length over octile length
  std::vector<double> first_ms, total_ms;
  int solved = 0;  ///< with a proof

  double mean() const {
    return ratios.empty() ? std::nan("")
                          : std::accumulate(ratios.begin(), ratios.end(), 0.0) /
                                static_cast<double>(ratios.size());
  }
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return values[static_cast<std::size_t>(std::lround(share * last))];
}

double milliseconds_since(SteadyClock::time_point begin) {
  return std::chrono::duration<double, std::milli>(SteadyClock::now() - begin).count();
}

void count(const PlanningMap& map, const PlanningProblem& problem, const SpaceLine& line,
           Score& score) {
  if (!proven_free(map.grid, line)) return;
  ++score.solved;
  // Where it starts at its goal there is no length to compare.
  if (problem.octile_length > 0.0) {
    score.ratios.push_back(length_of(line) / problem.octile_length);
  }
}

/// Ours, with a clock that ends it.
SpaceLine plan(AnyAnglePlanner& planner, const PlanningProblem& problem, double limit_s,
               Score& score) {
  const auto begin = SteadyClock::now();
  bool is_first = true;
  const AnyAnglePlanner::Plan plan = planner.plan(
      problem.start, problem.goal, [&] { return milliseconds_since(begin) >= 1e3 * limit_s; },
      [&](const AnyAnglePlanner::Plan&) {
        if (is_first) score.first_ms.push_back(milliseconds_since(begin));
        is_first = false;
      });
  score.total_ms.push_back(milliseconds_since(begin));
  return plan.line;
}

class Rows {
 public:
  explicit Rows(std::vector<ExperimentRow>& rows) : rows_(rows) {}
  ExperimentRow& add(const std::string& quantity, const char* unit, double value) {
    ExperimentRow& row = rows_.emplace_back();
    row.quantity = quantity;
    row.unit = unit;
    row.values = {value};
    return row;
  }

 private:
  std::vector<ExperimentRow>& rows_;
};

void append_score(const std::string& who, const PlanningMap& map, const Score& score, Rows& rows) {
  rows.add(who + " solved", "%", 100.0 * score.solved / static_cast<double>(map.problems.size()));
  rows.add(who + " length", "octile", score.mean());
}

void append_own_score(const std::string& name, const PlanningMap& map, const Score& score,
                      Rows& rows) {
  ExperimentRow& solved = rows.add(name + " solved, with proof", "%",
                                   100.0 * score.solved / static_cast<double>(map.problems.size()));
  solved.goal = 100.0;
  solved.more_is_better = true;
  rows.add(name + " length", "octile", score.mean());
  rows.add(name + " first path, p50", "ms", quantile(score.first_ms, 0.5)).goal = kFirstGoal_ms;
  rows.add(name + " last path, p50", "ms", quantile(score.total_ms, 0.5));
  rows.add(name + " last path, p99", "ms", quantile(score.total_ms, 0.99));
}

void append_collision_checks(const std::string& name, const PlanningMap& map, Rows& rows) {
  const CollisionComparison compared = compare_with_fcl(map.grid, kBallRadius, kChecks, kSeed);
  ExperimentRow& rate = rows.add(name + " collision checks, FCL's on OctoMap", "times",
                                 compared.peer_seconds / compared.seconds);
  rate.goal = kChecksGoal;
  rate.more_is_better = true;
  rows.add(name + " collision checks", "million/s", 1e-6 * compared.checks / compared.seconds);
  rows.add(name + " FCL's contacts", "%", 100.0 * compared.contacts / compared.checks);
  rows.add(name + " of these free by ours", "", compared.missed).goal = 0.0;
  rows.add(name + " contacts by ours alone", "%", 100.0 * compared.needless / compared.checks);
}

}  // namespace

Result<ExperimentResult> run_planning_benchmark(const ExperimentOptions& options) {
  const std::vector<PlanningMapFile> files = find_planning_maps(options.data);
  if (files.empty()) {
    return Error{
        fmt::format("{}: no X.map.gz with X.map.scen.gz and no X.3dmap.gz with X.3dmap.3dscen.gz "
                    "in it or below",
                    options.data.string())};
  }
  seed_ompl(kSeed);
  ExperimentResult result{"planning", 1, {}};
  Rows rows(result.rows);
  Score plane, space;
  int done = 0;
  for (const PlanningMapFile& file : files) {
    const auto map = read_planning_map(file, kProblems);
    if (!map.ok()) return map.error();
    const double limit_s = file.in_space ? kSpaceLimit_s : kPlaneLimit_s;
    AnyAnglePlanner planner(map->grid);
    Score ours, plain, informed;
    std::vector<SpaceLine> drawn;
    for (const PlanningProblem& problem : map->problems) {
      const SpaceLine line = plan(planner, problem, limit_s, ours);
      count(*map, problem, line, ours);
      if (!line.empty() && drawn.size() < kDrawn) drawn.push_back(line);
      count(*map, problem,
            plan_with_ompl(OmplPeer::kRrtConnect, map->grid, problem.start, problem.goal, limit_s),
            plain);
      count(*map, problem,
            plan_with_ompl(OmplPeer::kBitStar, map->grid, problem.start, problem.goal, limit_s),
            informed);
      options.progress(++done, static_cast<int>(files.size() * kProblems));
    }
    append_own_score(file.name, *map, ours, rows);
    append_score(file.name + " OMPL's RRTConnect", *map, plain, rows);
    append_score(file.name + " OMPL's BIT*", *map, informed, rows);
    if (file.in_space) append_collision_checks(file.name, *map, rows);
    std::vector<double>& all = file.in_space ? space.ratios : plane.ratios;
    all.insert(all.end(), ours.ratios.begin(), ours.ratios.end());
    if (options.report.empty()) continue;
    const Status saved =
        draw_map(map->grid, drawn, file.name, options.report / (file.name + ".png"));
    if (!saved.ok()) return saved.error();
  }
  if (!plane.ratios.empty()) {
    rows.add("plane, length within 50 ms, mean of all", "octile", plane.mean()).goal = kPlaneGoal;
  }
  if (!space.ratios.empty()) {
    rows.add("space, length within 200 ms, mean of all", "octile", space.mean()).goal = kSpaceGoal;
  }
  options.progress(done, done);
  return result;
}

}  // namespace swiftlet
