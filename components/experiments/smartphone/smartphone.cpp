// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/smartphone/smartphone.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "components/experiments/flight/flight_errors.hpp"
#include "components/experiments/flight/reference_flight.hpp"
#include "components/experiments/seed_000.hpp"
#include "components/experiments/shared_file.hpp"
#include "components/experiments/smartphone/smartphone_figures.hpp"
#include "components/sim/scenario.hpp"
#include "estimation/consistency/consistency_window.hpp"
#include "planner/trajectory/durations.hpp"
#include "planner/trajectory/limits.hpp"

namespace swiftlet {
namespace {

using namespace seed_000;
using Eigen::Vector3d;

constexpr double kClimb_s = 5.0;  // "after the taking-off phase (the first 5 s)"
constexpr double kRest_s = 3.0;   // before the take-off, see reference_flight.cpp

/// Rows for x, y and z, of which each run adds one value.
class AxisRows {
 public:
  AxisRows(const std::string& quantity, const std::string& unit, const std::string& source,
           const std::optional<Vector3d>& reference, const std::optional<Vector3d>& goal,
           bool goal_is_of_median = false) {
    for (int axis = 0; axis < 3; ++axis) {
      ExperimentRow& row = rows_[static_cast<std::size_t>(axis)];
      row.quantity = fmt::format("{}, {}", quantity, kAxes[axis]);
      row.unit = unit;
      row.source = source;
      if (reference) row.reference = (*reference)[axis];
      if (goal) row.goal = (*goal)[axis];
      row.goal_is_of_median = goal && goal_is_of_median;
    }
  }
  void add(const Vector3d& values) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rows_[axis].values.push_back(values[static_cast<Eigen::Index>(axis)]);
    }
  }
  void append_to(std::vector<ExperimentRow>& rows) const {
    rows.insert(rows.end(), rows_.begin(), rows_.end());
  }

 private:
  std::array<ExperimentRow, 3> rows_;
};

/// Whether squared errors over an ensemble of runs are as large as the covariance says: the share
/// of moments at which their mean over the runs lies within its 95 % band.
class EnsembleConsistency {
 public:
  explicit EnsembleConsistency(int degrees) : degrees_(degrees) {}
  void add(std::size_t moment, double normalised_square) {
    while (windows_.size() <= moment) windows_.emplace_back(degrees_);
    windows_[moment].add(normalised_square);
  }
  double share_inside() const {
    int inside = 0;
    for (const ConsistencyWindow& window : windows_) {
      inside += window.mean() > window.low() && window.mean() < window.high() ? 1 : 0;
    }
    return inside / std::max(1.0, static_cast<double>(windows_.size()));
  }
  /// Over all runs and moments, a degree of freedom: 1 where the covariance is right.
  double mean_a_degree() const {
    double sum = 0.0;
    for (const ConsistencyWindow& window : windows_) sum += window.mean() / degrees_;
    return sum / std::max(1.0, static_cast<double>(windows_.size()));
  }

 private:
  int degrees_;
  std::vector<ConsistencyWindow> windows_;
};

ReferenceFlight flight_of(const std::string& scenario, int seed) {
  ReferenceFlight flight;
  flight.scenario = shared_file(scenario);
  flight.seed = static_cast<std::uint64_t>(seed);
  flight.parameters = Config::load(shared_file("experiments/smartphone/parameters.yaml"));
  return flight;
}

/// At rest at a place.
FlatReference resting(const Vector3d& position) {
  FlatReference reference;
  reference.position = position;
  return reference;
}

/// Straight up to `home`, in the time that the paper takes for it.
Result<Trajectory> climb_to(const Scenario& scenario, const Vector3d& home) {
  const Vector3d ground(home.x(), home.y(), scenario.vehicle.ground.leg_height);
  return minimum_snap(Time{}, resting(ground), {{home, 0.0}}, {kClimb_s});
}

FlatReference at(const Trajectory& trajectory, double t) {
  return trajectory.evaluate(trajectory.start() + from_seconds(t));
}

struct FilterScore {
  AxisRows phone{"position RMSE of the phone", "m", "seed 000, Table 2", kPhonePosition, {}};
  AxisRows filter{"position RMSE of the UKF", "m", "seed 000, Table 2", kFilterPosition, {}};
  AxisRows ratio{"position RMSE, UKF to phone", "", "UKF to phone in Table 2",
                 kFilterPosition.cwiseQuotient(kPhonePosition), Vector3d(Vector3d::Ones())};
  AxisRows velocity{"velocity RMSE of the UKF", "m/s", "seed 000, Table 3", kFilterVelocity,
                    Vector3d(0.5 * kFilterVelocity)};
  ExperimentRow phone_psi, filter_psi, psi_ratio;
  EnsembleConsistency pose{6}, speed{3};

  FilterScore() {
    phone_psi = {"RMSE of Psi of the phone", "", kPhonePsi, "seed 000, Table 2", {}, {}, false};
    filter_psi = {"RMSE of Psi of the UKF", "", kFilterPsi, "seed 000, Table 2", {}, {}, false};
    psi_ratio = {"RMSE of Psi, UKF to phone",
                 "",
                 kFilterPsi / kPhonePsi,
                 "UKF to phone in Table 2",
                 {},
                 1.0,
                 false};
  }

  void add(const FlightSeries& series, double from_s, double to_s) {
    const Vector3d phone_error = rmse(series.phone, from_s, to_s, [](const PhoneMoment& m) {
      return Vector3d(m.p_WB - m.truth.p_WB);
    });
    const Vector3d filter_error = rmse(series.moments, from_s, to_s, [](const FlightMoment& m) {
      return Vector3d(m.estimate.p_WB - m.truth.p_WB);
    });
    phone.add(phone_error);
    filter.add(filter_error);
    ratio.add(filter_error.cwiseQuotient(phone_error));
    velocity.add(rmse(series.moments, from_s, to_s, [](const FlightMoment& m) {
      return Vector3d(m.estimate.v_WB_W - m.truth.v_WB_W);
    }));
    const double of_phone = psi_rmse(series.phone, from_s, to_s, [](const PhoneMoment& m) {
      return std::pair(m.q_WB, m.truth.q_WB);
    });
    const double of_filter = psi_rmse(series.moments, from_s, to_s, [](const FlightMoment& m) {
      return std::pair(m.estimate.q_WB, m.truth.q_WB);
    });
    phone_psi.values.push_back(of_phone);
    filter_psi.values.push_back(of_filter);
    psi_ratio.values.push_back(of_filter / of_phone);
    std::size_t moment = 0;
    for (const FlightMoment& m : series.moments) {
      // Ten moments a second, of the hundred.
      if (m.t < from_s || m.t > to_s || ++moment % 10 != 0) continue;
      pose.add(moment / 10 - 1, pose_nees(m));
      speed.add(moment / 10 - 1, velocity_nees(m));
    }
  }

  void append_to(std::vector<ExperimentRow>& rows) const {
    phone.append_to(rows);
    filter.append_to(rows);
    ratio.append_to(rows);
    rows.insert(rows.end(), {phone_psi, filter_psi, psi_ratio});
    velocity.append_to(rows);
    const auto consistency = [&rows](const char* quantity, double value, double goal) {
      rows.push_back({quantity, "", 0.95, "definition of the band", {value}, goal, true});
    };
    consistency("share of moments with the pose's NEES in its band", pose.share_inside(), 0.9);
    consistency("share of moments with the velocity's NEES in its band", speed.share_inside(), 0.9);
    rows.push_back({"mean NEES of the pose, a degree of freedom",
                    "",
                    1.0,
                    "an honest covariance",
                    {pose.mean_a_degree()},
                    {},
                    false});
    rows.push_back({"mean NEES of the velocity, a degree of freedom",
                    "",
                    1.0,
                    "an honest covariance",
                    {speed.mean_a_degree()},
                    {},
                    false});
  }
};

constexpr double kHover_s = 40.0;
const Vector3d kHome(0.2, 2.2, 1.2);
constexpr double kRadius = 0.05;  // around the home that counts as recovered [m]

/// The oval of 9 s through P1 to P4; in the paper's axes z is down.
const std::vector<Vector3d> kOval{
    {-1.0, -1.5, 1.2}, {0.0, -0.5, 1.2}, {0.0, 0.5, 1.2}, {-1.0, -1.5, 1.2}};
constexpr double kOval_s = 9.0;
constexpr double kWait_s = 3.0;  // before and after it, hovering

/// The oval, flown in as long as brings it to a speed.
Result<Trajectory> oval(double duration_s) {
  std::vector<Waypoint> waypoints;
  for (std::size_t i = 1; i < kOval.size(); ++i) waypoints.push_back({kOval[i], 0.0});
  const auto durations = least_snap_durations(resting(kOval[0]), waypoints, duration_s);
  if (!durations) return durations.error();
  return minimum_snap(Time{}, resting(kOval[0]), waypoints, *durations);
}

}  // namespace

Result<ExperimentResult> run_smartphone_hover(const ExperimentOptions& options) {
  const Scenario scenario = Scenario::load(shared_file("experiments/smartphone/hover.yaml"));
  const auto climb = climb_to(scenario, kHome);
  if (!climb) return climb.error();
  FilterScore score;
  std::vector<ExperimentRow> recoveries, true_recoveries, deviations;
  for (const Scenario::Push& push : scenario.pushes) {
    Vector3d::Index axis = 0;
    push.force.cwiseAbs().maxCoeff(&axis);
    recoveries.push_back({fmt::format("recovery to 5 cm after the push along {}", kAxes[axis]),
                          "s",
                          3.0,
                          "seed 000, System Stabilization",
                          {},
                          2.0,
                          false});
    true_recoveries.push_back(
        {fmt::format("the same of the truth, drift of the phone included, {}", kAxes[axis]),
         "s",
         {},
         "",
         {},
         {},
         false});
    deviations.push_back({fmt::format("how far the push along {} moves it", kAxes[axis]),
                          "m",
                          0.7,
                          "seed 000, Figure 7",
                          {},
                          0.6,
                          true});
  }
  for (int seed = 1; seed <= options.seeds; ++seed) {
    options.progress(seed - 1, options.seeds);
    ReferenceFlight flight = flight_of("experiments/smartphone/hover.yaml", seed);
    flight.reference = [&climb](double t) { return at(*climb, t); };
    flight.duration_s = kHover_s;
    const auto series = fly(flight);
    if (!series) return series.error();
    score.add(*series, kClimb_s, kHover_s);
    if (seed == 1 && !options.report.empty()) {
      PushTimes times;
      for (const Scenario::Push& push : scenario.pushes) {
        times.emplace_back(push.at_s - kRest_s, push.at_s - kRest_s + push.duration_s);
      }
      if (Status drawn = draw_hover(*series, times, options.report); !drawn) return drawn.error();
    }
    for (std::size_t i = 0; i < scenario.pushes.size(); ++i) {
      const double pushed_s = scenario.pushes[i].at_s - kRest_s;
      const double released_s = pushed_s + scenario.pushes[i].duration_s;
      const double until_s =
          i + 1 < scenario.pushes.size() ? scenario.pushes[i + 1].at_s - kRest_s : kHover_s;
      double farthest = 0.0;
      for (const FlightMoment& m : series->moments) {
        if (m.t < pushed_s || m.t > until_s) continue;
        farthest = std::max(farthest, (m.truth.p_WB - kHome).norm());
      }
      recoveries[i].values.push_back(
          recovery_s(series->moments, released_s, until_s, kHome, kRadius,
                     [](const FlightMoment& m) { return m.estimate.p_WB; }));
      true_recoveries[i].values.push_back(
          recovery_s(series->moments, released_s, until_s, kHome, kRadius,
                     [](const FlightMoment& m) { return m.truth.p_WB; }));
      deviations[i].values.push_back(farthest);
    }
  }
  options.progress(options.seeds, options.seeds);
  ExperimentResult result{"smartphone-hover", options.seeds, {}};
  score.append_to(result.rows);
  result.rows.insert(result.rows.end(), deviations.begin(), deviations.end());
  result.rows.insert(result.rows.end(), recoveries.begin(), recoveries.end());
  result.rows.insert(result.rows.end(), true_recoveries.begin(), true_recoveries.end());
  return result;
}

Result<ExperimentResult> run_smartphone_trajectory(const ExperimentOptions& options) {
  const Scenario scenario = Scenario::load(shared_file("experiments/smartphone/trajectory.yaml"));
  const auto climb = climb_to(scenario, kOval[0]);
  if (!climb) return climb.error();
  const auto slow = oval(kOval_s);
  if (!slow) return slow.error();
  const double speed_of_slow = slow->max_speed();

  ExperimentResult result{"smartphone-trajectory", options.seeds, {}};
  const std::array<double, 3> speeds{speed_of_slow, 1.5, 2.5};
  int done = 0;
  for (const double speed : speeds) {
    const bool as_paper = speed == speed_of_slow;
    const auto way = oval(kOval_s * speed_of_slow / speed);
    if (!way) return way.error();
    const double way_s = to_seconds(way->duration());
    const std::string at_speed = fmt::format("at {:.1f} m/s", way->max_speed());
    std::optional<Vector3d> position_goal, velocity_goal, truth_goal;
    if (as_paper) {
      position_goal = 0.6 * kPositionTracking;
      velocity_goal = 0.6 * kVelocityTracking;
      truth_goal = Vector3d::Constant(0.04);
    } else if (speed > 2.0) {
      position_goal = kPositionTracking;
      velocity_goal = kVelocityTracking;
    }
    AxisRows phone("position RMSE, phone to desired, " + at_speed, "m", "seed 000, Table 4",
                   kPhoneTracking, {});
    AxisRows position("position RMSE, UKF to desired, " + at_speed, "m", "seed 000, Table 4",
                      kPositionTracking, position_goal, true);
    AxisRows velocity("velocity RMSE, UKF to desired, " + at_speed, "m/s", "seed 000, Table 5",
                      kVelocityTracking, velocity_goal, true);
    AxisRows truth("position RMSE, truth to desired, " + at_speed, "m", "", {}, truth_goal, true);
    for (int seed = 1; seed <= options.seeds; ++seed) {
      options.progress(done++, static_cast<int>(speeds.size()) * options.seeds);
      const double begin_s = kClimb_s + kWait_s, end_s = begin_s + way_s;
      ReferenceFlight flight = flight_of("experiments/smartphone/trajectory.yaml", seed);
      flight.reference = [&](double t) {
        return t < begin_s ? at(*climb, t) : at(*way, t - begin_s);
      };
      flight.duration_s = end_s + kWait_s;
      // Thrust answers at once where tilt must be made first, so that height can be held more
      // firmly than the place.
      flight.parameters.set("flight_controller.position_gain", "[8, 8, 20]");
      flight.parameters.set("flight_controller.velocity_gain", "[4.5, 4.5, 12]");
      const auto series = fly(flight);
      if (!series) return series.error();
      if (seed == 1 && as_paper && !options.report.empty()) {
        Status drawn = draw_trajectory(*series, begin_s, end_s, options.report);
        if (!drawn) return drawn.error();
      }
      phone.add(rmse(series->phone, begin_s, end_s, [&](const PhoneMoment& m) {
        return Vector3d(m.p_WB - flight.reference(m.t).position);
      }));
      position.add(rmse(series->moments, begin_s, end_s, [](const FlightMoment& m) {
        return Vector3d(m.estimate.p_WB - m.desired.position);
      }));
      velocity.add(rmse(series->moments, begin_s, end_s, [](const FlightMoment& m) {
        return Vector3d(m.estimate.v_WB_W - m.desired.velocity);
      }));
      truth.add(rmse(series->moments, begin_s, end_s, [](const FlightMoment& m) {
        return Vector3d(m.truth.p_WB - m.desired.position);
      }));
    }
    for (const AxisRows* rows : {&phone, &position, &velocity, &truth}) {
      rows->append_to(result.rows);
    }
  }
  options.progress(done, done);
  return result;
}

}  // namespace swiftlet
