// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "components/experiments/data_table.hpp"
#include "components/experiments/euroc/euroc.hpp"
#include "components/experiments/euroc/motion_log.hpp"
#include "components/experiments/flight/flight_errors.hpp"
#include "components/experiments/shared_file.hpp"
#include "components/sim/scenario.hpp"
#include "planner/trajectory/limits.hpp"
#include "planner/trajectory/minimum_snap.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector3d;

/// Between the points of a recorded flight that the reference passes [s]: fine enough to keep its
/// turns, wide enough to leave the noise of the motion capture behind.
constexpr double kSpacing_s = 0.25;
constexpr double kLowest = 1.0;  // of the reference above the ground [m]
constexpr double kClimb_s = 5.0;
constexpr double kWait_s = 2.0;  // hovering before and after
constexpr int kStretches = 20;

/// What the simulated vehicle is asked for at most: well within its thrust, 2.1 times its weight,
/// and the tilt that its controller allows.
TrajectoryLimits vehicle_limits() {
  TrajectoryLimits limits;
  limits.max_speed = 4.0;
  limits.max_acceleration = 5.0;
  limits.max_thrust_per_mass = 15.0;
  limits.min_thrust_per_mass = 5.0;
  limits.max_body_rate = 4.0;
  return limits;
}

struct Reference {
  std::string name;
  Trajectory trajectory;
  double stretch = 1.0;  ///< how much slower than it was flown
};

Result<Trajectory> through(const std::vector<Waypoint>& points, double piece_s) {
  FlatReference start;
  start.position = points.front().position;
  return minimum_snap(Time{}, start, {points.begin() + 1, points.end()},
                      std::vector<double>(points.size() - 1, piece_s));
}

/// The recorded positions as a minimum-snap trajectory from rest to rest, slowed down until the
/// limits hold.
Result<Reference> reference_of(const std::filesystem::path& file) {
  const auto log = MotionLog::read(file);
  if (!log) return log.error();
  std::vector<Waypoint> points;
  for (Time time = log->begin(); time <= log->end(); time += from_seconds(kSpacing_s)) {
    const auto state = log->at(time);
    if (state) points.push_back({state->p_WB, 0.0});
  }
  if (points.size() < 3) {
    return Error{fmt::format("{}: less than {} s of motion", file.string(), 3 * kSpacing_s)};
  }
  double lowest = points.front().position.z();
  for (const Waypoint& point : points) lowest = std::min(lowest, point.position.z());
  const Vector3d origin(points.front().position.x(), points.front().position.y(), lowest - kLowest);
  for (Waypoint& point : points) point.position -= origin;

  Reference reference;
  reference.name = file.filename().string();
  reference.name = reference.name.substr(0, reference.name.find('.'));
  const TrajectoryLimits limits = vehicle_limits();
  for (int round = 0; round < kStretches; ++round) {
    auto trajectory = through(points, reference.stretch * kSpacing_s);
    if (!trajectory) return trajectory.error();
    double needed = 1.0;
    for (const TrajectorySegment& segment : trajectory->segments()) {
      needed = std::max(needed, needed_stretch(segment, limits));
    }
    reference.trajectory = *std::move(trajectory);
    if (needed <= 1.0) return reference;
    reference.stretch *= needed * 1.001;
  }
  return Error{fmt::format("{}: no time scale keeps the vehicle's limits", file.string())};
}

/// All motion that the folder has. Where one flight comes in several forms each is flown.
Result<std::vector<Reference>> read_references(const std::filesystem::path& folder) {
  std::vector<Reference> references;
  for (const auto& file :
       find_files(folder, R"((.*(gt|groundtruth).*\.(csv|txt)|.*\.tum(\.txt)?)(\.gz)?)")) {
    // Trajectories of programs to be scored against, not flights.
    if (file.string().find("eval_reference") != std::string::npos) continue;
    auto reference = reference_of(file);
    if (!reference) return reference.error();
    const std::string parent = file.parent_path().filename().string();
    if (parent != "groundtruth_traj") reference->name = parent + ", " + reference->name;
    references.push_back(*std::move(reference));
  }
  if (references.empty()) {
    return Error{fmt::format("{}: no ground truth (gt*.csv, gt*.txt or *.tum.txt) in it or below",
                             folder.string())};
  }
  return references;
}

ExperimentRow row(const std::string& quantity, const std::string& unit) {
  ExperimentRow row;
  row.quantity = quantity;
  row.unit = unit;
  return row;
}

}  // namespace

Result<ExperimentResult> run_euroc_flights(const ExperimentOptions& options) {
  const auto references = read_references(options.data);
  if (!references) return references.error();
  const std::filesystem::path scenario_file = shared_file("experiments/euroc/flight.yaml");
  const Scenario scenario = Scenario::load(scenario_file);
  ExperimentResult result{"euroc-flights", options.seeds, {}};
  int done = 0;
  const int total = options.seeds * static_cast<int>(references->size());
  for (const Reference& reference : *references) {
    const FlatReference first = reference.trajectory.evaluate(reference.trajectory.start());
    FlatReference ground = first;
    ground.position.z() = scenario.vehicle.ground.leg_height;
    const auto climb = minimum_snap(Time{}, ground, {{first.position, 0.0}}, {kClimb_s});
    if (!climb) return climb.error();
    const double begin_s = kClimb_s + kWait_s;
    const double end_s = begin_s + to_seconds(reference.trajectory.duration());
    ReferenceFlight flight;
    flight.scenario = scenario_file;
    flight.parameters = Config::load(shared_file("experiments/smartphone/parameters.yaml"));
    flight.duration_s = end_s + kWait_s;
    flight.reference = [&](double t) {
      return t < begin_s ? climb->evaluate(Time(from_seconds(t)))
                         : reference.trajectory.evaluate(Time(from_seconds(t - begin_s)));
    };
    ExperimentRow stretch = row(reference.name + ": slower than it was flown, times", "");
    ExperimentRow speed = row(reference.name + ": greatest speed", "m/s");
    ExperimentRow truth = row(reference.name + ": position RMSE, truth to reference", "m");
    ExperimentRow estimate = row(reference.name + ": position RMSE, UKF to reference", "m");
    ExperimentRow filter = row(reference.name + ": position RMSE, UKF to truth", "m");
    stretch.values.push_back(reference.stretch);
    speed.values.push_back(reference.trajectory.max_speed());
    for (int seed = 1; seed <= options.seeds; ++seed) {
      options.progress(done++, total);
      flight.seed = static_cast<std::uint64_t>(seed);
      const auto series = fly(flight);
      if (!series) return Error{reference.name + ": " + series.error().reason};
      truth.values.push_back(rmse(series->moments, begin_s, end_s, [](const FlightMoment& m) {
                               return Vector3d(m.truth.p_WB - m.desired.position);
                             }).norm());
      estimate.values.push_back(rmse(series->moments, begin_s, end_s, [](const FlightMoment& m) {
                                  return Vector3d(m.estimate.p_WB - m.desired.position);
                                }).norm());
      filter.values.push_back(rmse(series->moments, begin_s, end_s, [](const FlightMoment& m) {
                                return Vector3d(m.estimate.p_WB - m.truth.p_WB);
                              }).norm());
    }
    result.rows.insert(result.rows.end(), {stretch, speed, truth, estimate, filter});
  }
  options.progress(total, total);
  return result;
}

}  // namespace swiftlet
