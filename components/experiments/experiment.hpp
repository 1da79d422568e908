// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "estimation/basics/result.hpp"

namespace swiftlet {

/// One line of a paper's table beside ours.
struct ExperimentRow {
  std::string quantity;  ///< "position RMSE of the UKF, x"
  std::string unit;      ///< "m"; "" for a plain number
  std::optional<double> reference;
  std::string source;          ///< of the reference: "seed 000, Table 2"
  std::vector<double> values;  ///< ours, one a seed or a file
  std::optional<double> goal;  ///< what the worst of ours must not be beyond
  bool more_is_better = false;
  /// The goal is one for the median: where the paper has the figure of a single run.
  bool goal_is_of_median = false;

  double median() const;
  /// The largest of the values, or the least where more is better.
  double worst() const;
  /// Also where there is no goal.
  bool holds() const;
};

struct ExperimentResult {
  std::string name;
  int seeds = 0;
  std::vector<ExperimentRow> rows;

  bool holds() const;
};

struct ExperimentOptions {
  int seeds = 20;
  std::filesystem::path report;  ///< folder for figures; empty for none
  std::filesystem::path data;    ///< folder with what it reads
  /// Called as the work goes on, with what is done and how much there is.
  std::function<void(int done, int total)> progress = [](int, int) {};
};

/// Something of a paper, run again.
struct Experiment {
  std::string name;     ///< as on the command line: "smartphone-hover"
  std::string summary;  ///< in a line
  bool reads_data = false;
  /// Errors are for the person who asked: what is missing or broken, and what to do.
  Result<ExperimentResult> (*run)(const ExperimentOptions&) = nullptr;
};

/// All there are.
const std::vector<Experiment>& experiments();

/// The table, for people: ours beside the paper's.
std::string to_table(const ExperimentResult& result);
/// One object: {"name", "seeds", "rows": [{"quantity", "unit", "reference", "source",
/// "median", "worst", "goal", "holds"}]}.
std::string to_json(const ExperimentResult& result);

}  // namespace swiftlet
