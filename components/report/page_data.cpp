// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/page_data.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "components/report/html_text.hpp"

namespace swiftlet {
namespace {

using nlohmann::json;

constexpr const char* kAxes[] = {"x", "y", "z"};
constexpr double kSamePlace = 0.05;  // [m]
constexpr double kMapMargin = 0.4;   // around what is drawn [m]
/// Later than this a clock counts from 1970, and the page can say the time of day [ns].
constexpr mcap::Timestamp kYear2000 = 946'684'800'000'000'000;

/// A number with so many digits behind the point, which is shorter than the number itself.
double rounded(double value, int digits) {
  const double scale = std::pow(10.0, digits);
  return std::round(value * scale) / scale;
}

std::int64_t milliseconds(double seconds) {
  return std::llround(seconds * 1e3);
}

json packed(const PlotLine& line, int digits) {
  json t = json::array(), v = json::array(), b = json::array();
  std::int64_t last = 0;
  for (const CurvePoint& point : line.curve->points()) {
    const std::int64_t time = milliseconds(point.time);
    if (point.begins) b.push_back(t.size());
    t.push_back(time - std::exchange(last, time));
    v.push_back(rounded(point.value, digits + 1));
  }
  return {{"name", line.name}, {"look", line.look}, {"t", t}, {"v", v}, {"b", b}};
}

/// The way as the script unpacks it, as a series.
json packed(const Track& track) {
  json t = json::array(), x = json::array(), y = json::array();
  std::int64_t last = 0;
  for (const TrackPoint& point : track.points()) {
    const std::int64_t time = milliseconds(point.time);
    t.push_back(time - std::exchange(last, time));
    x.push_back(rounded(point.position.x(), 3));
    y.push_back(rounded(point.position.y(), 3));
  }
  return {{"t", t}, {"x", x}, {"y", y}, {"b", json::array()}};
}

/// Goals that are not a waypoint, which is drawn already.
std::vector<Place> goals_beside(const std::vector<Place>& waypoints, std::vector<Place> goals) {
  const auto is_waypoint = [&waypoints](const Place& goal) {
    return std::any_of(waypoints.begin(), waypoints.end(), [&goal](const Place& waypoint) {
      return (waypoint.position - goal.position).norm() < kSamePlace;
    });
  };
  goals.erase(std::remove_if(goals.begin(), goals.end(), is_waypoint), goals.end());
  return goals;
}

json corner(const Eigen::Vector2d& position) {
  return {rounded(position.x(), 4), rounded(position.y(), 4)};
}

json map_data(const FlightStory& story, const std::optional<MapPicture>& picture) {
  if (!has_map(story)) return nullptr;
  const FlightMap& map = story.map;
  json places = json::array();
  Eigen::AlignedBox2d box;
  const auto add = [&](const std::vector<Place>& some, const char* kind) {
    for (const Place& place : some) {
      box.extend(place.position);
      places.push_back({{"kind", kind},
                        {"t", rounded(place.time, 3)},
                        {"x", rounded(place.position.x(), 3)},
                        {"y", rounded(place.position.y(), 3)},
                        {"label", place.label}});
    }
  };
  add(goals_beside(map.waypoints, map.goals), "goal");
  add(map.guard_acts, "guard");
  add(map.contacts, "contact");
  add(map.takeoffs, "takeoff");
  add(map.landings, "landing");
  add(map.waypoints, "waypoint");
  for (const TrackPoint& point : map.flown.points()) box.extend(point.position);
  for (const TrackPoint& point : map.asked.points()) box.extend(point.position);
  json image = nullptr;
  if (picture) {
    box.extend(picture->lower);
    box.extend(picture->upper);
    image = {{"png", "data:image/png;base64," + html::base64(picture->png)},
             {"lower", corner(picture->lower)},
             {"upper", corner(picture->upper)}};
  }
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(kMapMargin);
  return {{"lower", corner(box.min() - margin)},
          {"upper", corner(box.max() + margin)},
          {"picture", image},
          {"flown", packed(map.flown)},
          {"asked", packed(map.asked)},
          {"places", places}};
}

/// Adds the plot with those of its lines that are not empty; none where its first is.
void add_plot(std::vector<TimePlot>& plots, TimePlot plot, std::size_t needed = 0) {
  if (plot.lines[needed].curve->empty()) return;
  auto& lines = plot.lines;
  lines.erase(std::remove_if(lines.begin(), lines.end(),
                             [](const PlotLine& line) { return line.curve->empty(); }),
              lines.end());
  plots.push_back(std::move(plot));
}

TimePlot by_axis(const char* section, const char* title, const Curve3& curves, int digits) {
  TimePlot plot{section, title, "m", digits, 0.5, {}};
  for (std::size_t i = 0; i < 3; ++i) plot.lines.push_back({kAxes[i], kAxes[i], &curves[i]});
  return plot;
}

}  // namespace

std::vector<TimePlot> plots_of(const FlightStory& story) {
  const FlightCurves& curves = story.curves;
  std::vector<TimePlot> plots;
  for (std::size_t i = 0; i < 3; ++i) {
    TimePlot plot{"Position", kAxes[i], "m", 3, 0.5, {}};
    plot.lines = {{"truth", "truth", &curves.truth[i]},
                  {"setpoint", "setpoint", &curves.setpoint[i]},
                  {"estimate", "estimate", &curves.estimate[i]}};
    const bool has_estimate = !curves.estimate[i].empty();
    add_plot(plots, std::move(plot), has_estimate ? 2 : curves.setpoint[i].empty() ? 0 : 1);
  }
  add_plot(plots, by_axis("Error", "estimate − setpoint", curves.error, 3));
  add_plot(plots, by_axis("Error", "estimate − truth", curves.estimate_error, 3));
  add_plot(plots,
           by_axis("Error", "standard deviation that the estimator claims", curves.sigma, 4));
  add_plot(plots, {"Speed",
                   "speed",
                   "m/s",
                   2,
                   0.5,
                   {{"estimate", "estimate", &curves.speed},
                    {"setpoint", "setpoint", &curves.setpoint_speed},
                    {"climb rate", "climb", &curves.climb_rate}}});
  add_plot(plots, {"Attitude",
                   "roll and pitch",
                   "deg",
                   1,
                   0.5,
                   {{"roll", "roll", &curves.roll}, {"pitch", "pitch", &curves.pitch}}});
  add_plot(plots, {"Attitude",
                   "yaw",
                   "deg",
                   1,
                   0.5,
                   {{"estimate", "estimate", &curves.yaw},
                    {"setpoint", "setpoint", &curves.setpoint_yaw}}});
  constexpr double kBatteryReach = 3.0;
  add_plot(plots, {"Battery",
                   "charge",
                   "%",
                   1,
                   kBatteryReach,
                   {{"percentage", "estimate", &curves.battery_percentage}}});
  add_plot(plots, {"Battery",
                   "voltage",
                   "V",
                   2,
                   kBatteryReach,
                   {{"voltage", "estimate", &curves.battery_voltage}}});
  add_plot(plots, {"Battery",
                   "current",
                   "A",
                   2,
                   kBatteryReach,
                   {{"current", "estimate", &curves.battery_current}}});
  for (const Consistency& consistency : curves.consistencies) {
    add_plot(plots, {"Estimator",
                     consistency.name,
                     "",
                     2,
                     2.0,
                     {{"mean", "estimate", &consistency.value},
                      {"95 % bounds", "limit", &consistency.low},
                      {"", "limit", &consistency.high}}});
  }
  return plots;
}

json page_data(const FlightStory& story, const std::vector<TimePlot>& plots,
               const std::optional<MapPicture>& picture) {
  json data;
  data["duration"] = rounded(story.recording.duration, 3);
  data["epoch"] =
      story.recording.begin > kYear2000 ? json(story.recording.begin / 1'000'000) : json(nullptr);
  data["modes"] = json::array();
  for (const ModeSpan& span : story.modes) {
    data["modes"].push_back({rounded(span.from, 3), rounded(span.to, 3), span.mode});
  }
  data["marks"] = json::array();
  for (const FlightEvent& event : story.events.sorted()) {
    if (event.level == FlightEvent::Level::kInfo) continue;
    data["marks"].push_back(
        {rounded(event.time, 3), event.level == FlightEvent::Level::kError ? "error" : "warning"});
  }
  data["plots"] = json::array();
  for (const TimePlot& plot : plots) {
    json series = json::array();
    for (const PlotLine& line : plot.lines) series.push_back(packed(line, plot.digits));
    data["plots"].push_back({{"title", plot.title},
                             {"unit", plot.unit},
                             {"digits", plot.digits},
                             {"reach", plot.reach},
                             {"series", series}});
  }
  data["map"] = map_data(story, picture);
  return data;
}

bool has_map(const FlightStory& story) {
  const FlightMap& map = story.map;
  return map.grid || !map.flown.points().empty() || !map.asked.points().empty() ||
         !map.waypoints.empty();
}

}  // namespace swiftlet
