// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/experiment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "components/experiments/euroc/euroc.hpp"
#include "components/experiments/exploration/exploration.hpp"
#include "components/experiments/planning/planning_benchmark.hpp"
#include "components/experiments/slam/slam_benchmark.hpp"
#include "components/experiments/smartphone/smartphone.hpp"

namespace swiftlet {
namespace {

nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

}  // namespace

double ExperimentRow::median() const {
  if (values.empty()) return std::nan("");
  for (const double value : values) {
    if (std::isnan(value)) return value;
  }
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
}

double ExperimentRow::worst() const {
  if (values.empty()) return std::nan("");
  // Not std::max_element, which a value that is no number would pass by.
  double worst = values.front();
  for (const double value : values) {
    if (std::isnan(value)) return value;
    worst = more_is_better ? std::min(worst, value) : std::max(worst, value);
  }
  return worst;
}

bool ExperimentRow::holds() const {
  if (!goal) return true;
  const double held_against = goal_is_of_median ? median() : worst();
  return more_is_better ? held_against >= *goal : held_against <= *goal;
}

bool ExperimentResult::holds() const {
  return !rows.empty() && std::all_of(rows.begin(), rows.end(),
                                      [](const ExperimentRow& row) { return row.holds(); });
}

const std::vector<Experiment>& experiments() {
  static const std::vector<Experiment> all{
      {"smartphone-hover", "hover with pushes of 0.7 m, Tables 2 and 3 of seed 000", false,
       run_smartphone_hover},
      {"smartphone-trajectory", "the oval of 9 s and faster ones, Tables 4 and 5 of seed 000",
       false, run_smartphone_trajectory},
      {"euroc-filter", "the filter on a real IMU, with poses as good as seed 000's", true,
       run_euroc_filter},
      {"euroc-flights", "real flights as references in simulation", true, run_euroc_flights},
      {"slam-benchmark", "the mapper on real logs, scored by relations that people verified", true,
       run_slam_benchmark},
      {"planning", "public maps in the plane and in space, beside OMPL's planners", true,
       run_planning_benchmark},
      {"exploration", "the unknown house, explored and left, beside the rule of 1997", false,
       run_exploration},
  };
  return all;
}

std::string to_table(const ExperimentResult& result) {
  std::size_t width = 8;
  for (const ExperimentRow& row : result.rows) {
    width = std::max(width, row.quantity.size() + (row.unit.empty() ? 0 : row.unit.size() + 3));
  }
  std::string text =
      fmt::format("{}, {} {}\n\n", result.name, result.seeds, result.seeds == 1 ? "run" : "runs");
  text += fmt::format("{:{}}  {:>9}  {:>9}  {:>9}  {:>9}   {}\n", "", width, "paper", "median",
                      "worst", "goal", "source");
  for (const ExperimentRow& row : result.rows) {
    const std::string name =
        row.unit.empty() ? row.quantity : fmt::format("{} [{}]", row.quantity, row.unit);
    text += fmt::format(
        "{:{}}  {:>9}  {:>9.4f}  {:>9.4f}  {:>9}{}  {}{}\n", name, width,
        row.reference ? fmt::format("{:.4f}", *row.reference) : "-", row.median(), row.worst(),
        row.goal ? fmt::format("{} {:.4f}", row.more_is_better ? ">" : "<", *row.goal) : "",
        row.goal_is_of_median ? "*" : " ", row.source, row.holds() ? "" : "  MISSED");
  }
  int goals = 0, missed = 0, of_medians = 0;
  for (const ExperimentRow& row : result.rows) {
    goals += row.goal ? 1 : 0;
    of_medians += row.goal_is_of_median ? 1 : 0;
    missed += row.holds() ? 0 : 1;
  }
  if (of_medians > 0) text += "\n* of the median; the others are of the worst\n";
  text += missed == 0 ? fmt::format("\nall {} goals are met\n", goals)
                      : fmt::format("\n{} of {} goals are missed\n", missed, goals);
  return text;
}

std::string to_json(const ExperimentResult& result) {
  nlohmann::json json;
  json["name"] = result.name;
  json["seeds"] = result.seeds;
  json["rows"] = nlohmann::json::array();
  for (const ExperimentRow& row : result.rows) {
    json["rows"].push_back(
        {{"quantity", row.quantity},
         {"unit", row.unit},
         {"reference", row.reference ? nlohmann::json(*row.reference) : nlohmann::json(nullptr)},
         {"source", row.source},
         {"median", number(row.median())},
         {"worst", number(row.worst())},
         {"goal", row.goal ? nlohmann::json(*row.goal) : nlohmann::json(nullptr)},
         {"holds", row.holds()}});
  }
  return json.dump(2) + "\n";
}

}  // namespace swiftlet
