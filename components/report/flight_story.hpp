// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/bag/loss_ledger.hpp"
#include "components/bag/mcap/records.hpp"
#include "components/report/event_log.hpp"
#include "components/report/path_error.hpp"
#include "components/report/thinned_curve.hpp"
#include "components/report/topic_health.hpp"
#include "perception/occupancy_grid.hpp"

/// What a recording tells of a flight, as plain values. Times are seconds since the beginning of
/// the recording, positions are in the map [m], angles in degrees. What the recording cannot tell
/// is not there: an empty optional, a curve without points.
namespace swiftlet {

/// The recording itself.
struct RecordingFacts {
  std::string name;
  std::vector<std::string> files;
  std::uint64_t bytes = 0;
  std::uint64_t messages = 0;
  mcap::Timestamp begin = 0;  ///< on the clock of the run [ns]
  double duration = 0.0;      ///< [s]
  bool finished = true;       ///< all files were closed
  std::string vehicle;        ///< prefix of the topics that were read, "" for none
  /// What the recording says of its run: version, components, parameters, ...
  std::map<std::string, std::string> run;
  /// What is damaged, missing, contradictory or was not understood.
  std::vector<std::string> remarks;
  bool has_ledger = false;  ///< losses are known
};

struct ModeSpan {
  double from = 0.0, to = 0.0;  ///< [s]
  std::string mode;             ///< "Indoor Navigation"
};

using Curve3 = std::array<ThinnedCurve, 3>;

/// A consistency that a component reports of its estimates (NIS, NEES), beside the bounds between
/// which 95 of 100 lie where the covariances are honest.
struct Consistency {
  std::string name;  ///< "estimator: nis_mean"
  ThinnedCurve value, low, high;
  std::uint64_t count = 0;   ///< with both bounds
  std::uint64_t inside = 0;  ///< of these, between the bounds
  double sum = 0.0;
};

struct FlightCurves {
  explicit FlightCurves(double duration);

  Curve3 estimate, setpoint, truth;  ///< [m]
  Curve3 error;                      ///< estimate - setpoint, in flight and not while landing [m]
  Curve3 estimate_error;             ///< estimate - truth, in flight [m]
  Curve3 sigma;                      ///< that the estimator claims of its position [m]
  ThinnedCurve speed, setpoint_speed, climb_rate;  ///< [m/s]
  ThinnedCurve roll, pitch, yaw, setpoint_yaw;     ///< [deg]
  ThinnedCurve battery_percentage;                 ///< [%]
  ThinnedCurve battery_voltage;                    ///< [V]
  ThinnedCurve battery_current;                    ///< [A]
  std::vector<Consistency> consistencies;
};

/// How near the vehicle was to where it should have been.
struct Tracking {
  Eigen::Vector3d rms = Eigen::Vector3d::Zero();  ///< [m]
  double largest = 0.0;                           ///< [m]
};

/// What a battery gave.
struct BatteryUse {
  std::optional<double> first_percentage, last_percentage;  ///< [%]
  double energy = 0.0;                                      ///< [W h]
  std::optional<double> lowest_voltage;                     ///< [V]
};

struct FlightFigures {
  std::optional<double> flight_time;      ///< not on the ground [s]
  std::optional<double> distance;         ///< in flight, in steps of Track::kStep [m]
  std::optional<double> largest_speed;    ///< [m/s]
  std::optional<double> largest_height;   ///< above the take-off point [m]
  std::optional<Tracking> tracking;       ///< estimate against setpoint, not while landing
  std::optional<Tracking> true_tracking;  ///< truth against setpoint, not while landing
  std::optional<Tracking> estimation;     ///< estimate against truth, in flight
  std::optional<BatteryUse> battery;
  std::optional<std::uint32_t> contacts;
  std::string last_contact;
  std::optional<double> least_clearance;  ///< [m]
  std::optional<double> landing_error;    ///< last landing to take-off point, on the plane, by the
                                          ///< truth where that is known [m]
};

/// How it ended, in words.
struct Outcome {
  FlightEvent::Level level = FlightEvent::Level::kInfo;
  std::string text;
};

/// A place on the map, with what happened there.
struct Place {
  double time = 0.0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  std::string label;
};

struct FlightMap {
  std::optional<OccupancyGrid> grid;  ///< the last that was published
  double grid_time = 0.0;
  Track flown, asked;
  std::vector<Place> takeoffs, landings, waypoints, goals, contacts, guard_acts;
  std::uint64_t global_waypoints = 0;  ///< places on Earth, which are not drawn
};

struct FlightStory {
  explicit FlightStory(double duration) : curves(duration) {}

  RecordingFacts recording;
  Outcome outcome;
  FlightFigures figures;
  std::vector<ModeSpan> modes;
  FlightCurves curves;
  EventLog events;
  FlightMap map;
  std::vector<TopicHealth> topics;  ///< all of the vehicle, by name
  /// Whether a topic is in the recording, with a message.
  bool has(const std::string& topic) const;
};

}  // namespace swiftlet
