// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/mission/waypoints_form.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "gcs/mission/line_problem.hpp"
#include "gcs/mission/mavlink_item.hpp"

namespace swiftlet {
namespace {

constexpr const char* kHead = "QGC WPL 110";
constexpr std::size_t kColumns = 12;
constexpr double kNorth = 360.0;  // where 0 is none [deg]

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

double number_of(const std::string& word, int line) {
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (end == word.c_str() || *end != '\0' || std::isinf(value)) {
    throw LineProblem(line, fmt::format("'{}' is no finite number; correct it", word));
  }
  return value;
}

int whole_of(const std::string& word, int line) {
  const double value = number_of(word, line);
  if (!(value == std::floor(value) && std::abs(value) < 1e6)) {
    throw LineProblem(line, fmt::format("'{}' is no whole number; correct it", word));
  }
  return static_cast<int>(value);
}

MavlinkItem read_item(const std::vector<std::string>& words, std::size_t index, int line) {
  if (words.size() != kColumns) {
    throw LineProblem(line, fmt::format("{} columns, not {}: index, current, frame, command, four "
                                        "parameters, latitude, longitude, altitude, autocontinue",
                                        words.size(), kColumns));
  }
  if (static_cast<std::size_t>(whole_of(words[0], line)) != index) {
    throw LineProblem(line,
                      fmt::format("the index is {}, not {}; is a line missing?", words[0], index));
  }
  whole_of(words[1], line);  // where a vehicle was
  MavlinkItem item;
  item.line = line;
  item.frame = whole_of(words[2], line);
  item.command = whole_of(words[3], line);
  for (std::size_t i = 0; i < item.params.size(); ++i) {
    item.params[i] = number_of(words[4 + i], line);
  }
  if (item.yaw_deg() == 0.0) item.params[3] = std::numeric_limits<double>::quiet_NaN();
  item.continues = whole_of(words[11], line) != 0;
  return item;
}

bool is_home(const MavlinkItem& first) {
  return first.command == mav::kWaypoint && first.frame == mav::kFrameSea;
}

GlobalPosition home_of(const MavlinkItem& item) {
  const GlobalPosition home{item.latitude(), item.longitude(), item.altitude()};
  if (home.usable()) return home;
  throw LineProblem(item.line, fmt::format("home at {}, {}, {} m is no place on Earth; correct it",
                                           home.latitude, home.longitude, home.altitude));
}

std::string format_item(const MavlinkItem& item, std::size_t index) {
  std::string text =
      fmt::format("{}\t{}\t{}\t{}", index, index == 0 ? 1 : 0, item.frame, item.command);
  for (std::size_t i = 0; i < item.params.size(); ++i) {
    const bool is_north = i == 3 && item.command == mav::kWaypoint && item.params[i] == 0.0;
    const double value = std::isnan(item.params[i]) ? 0.0 : is_north ? kNorth : item.params[i];
    text += fmt::format("\t{}", value);
  }
  return text + "\t1\n";
}

}  // namespace

MissionFile parse_waypoints(const std::string& text, const MissionReading& reading) {
  std::istringstream stream(text);
  std::string line;
  std::getline(stream, line);
  int number = 1;
  if (words_of(line) != words_of(kHead)) {
    throw LineProblem(number,
                      fmt::format("does not begin with '{}'; is it a list of waypoints?", kHead));
  }
  MissionFile mission;
  std::vector<MavlinkItem> items;
  std::size_t index = 0;
  while (std::getline(stream, line)) {
    ++number;
    const std::vector<std::string> words = words_of(line);
    if (words.empty()) continue;
    const MavlinkItem item = read_item(words, index++, number);
    if (index == 1 && is_home(item)) {
      mission.home = home_of(item);
    } else {
      items.push_back(item);
    }
  }
  std::optional<double> home_altitude = reading.home_altitude;
  if (!home_altitude && mission.home) home_altitude = mission.home->altitude;
  add_mavlink_items(items, home_altitude, mission);
  return mission;
}

Result<MissionText> format_waypoints(const MissionFile& mission) {
  Result<MavlinkMission> translated = to_mavlink(mission);
  if (!translated.ok()) return translated.error();
  const GlobalPosition& home = translated->home;
  MavlinkItem first;
  first.frame = mav::kFrameSea;
  first.params = {0, 0, 0, 0, home.latitude, home.longitude, home.altitude};
  first.params[3] = std::numeric_limits<double>::quiet_NaN();
  MissionText result{std::string(kHead) + "\n" + format_item(first, 0),
                     std::move(translated->losses)};
  std::size_t index = 1;
  for (const MavlinkItem& item : translated->items) result.text += format_item(item, index++);
  const auto lose = [&](bool is_lost, const char* what) {
    if (is_lost) result.losses.push_back({0, what});
  };
  lose(!mission.name.empty(), "a list of waypoints has no name; that of the mission is left out");
  lose(mission.cruise_speed.has_value(), "a list of waypoints has no cruise speed; it is left out");
  lose(!mission.fence.empty(), "a list of waypoints has no fence; it is left out");
  return result;
}

}  // namespace swiftlet
