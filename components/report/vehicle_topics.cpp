// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/vehicle_topics.hpp"

#include <fmt/format.h>

#include <set>
#include <string_view>

#include "components/topics.hpp"

namespace swiftlet {
namespace {

std::string_view without_slash(std::string_view topic) {
  return !topic.empty() && topic.front() == '/' ? topic.substr(1) : topic;
}

/// The vehicles of the topics of the stack; "" stands for topics without one.
std::set<std::string> vehicles_in(const Recording& recording) {
  std::set<std::string> vehicles;
  for (const auto& [id, channel] : recording.channels()) {
    const std::string_view recorded = without_slash(channel.topic);
    // "uav1/gps/fix" is of uav1: the longest topic that the name ends with tells the vehicle.
    std::optional<std::string_view> shortest;
    for (const std::string_view name : topic::names) {
      if (recorded.size() < name.size() || recorded.substr(recorded.size() - name.size()) != name) {
        continue;
      }
      const std::string_view before = recorded.substr(0, recorded.size() - name.size());
      if (!before.empty() && before.back() != '/') continue;
      if (!shortest || before.size() < shortest->size()) shortest = before;
    }
    if (!shortest) continue;
    vehicles.emplace(shortest->empty() ? *shortest : shortest->substr(0, shortest->size() - 1));
  }
  return vehicles;
}

std::string listed(const std::set<std::string>& vehicles) {
  std::string text;
  for (const std::string& name : vehicles) {
    if (!name.empty()) text += (text.empty() ? "" : ", ") + name;
  }
  return text.empty() ? "none" : text;
}

}  // namespace

std::optional<std::string> topic_of_vehicle(const std::string& recorded,
                                            const std::string& vehicle) {
  const std::string_view topic = without_slash(recorded);
  if (vehicle.empty()) return std::string(topic);
  const std::string prefix = vehicle + "/";
  if (topic.substr(0, prefix.size()) != prefix) return std::nullopt;
  return std::string(topic.substr(prefix.size()));
}

Result<std::string> vehicle_of(const Recording& recording, const std::string& wanted) {
  const std::set<std::string> vehicles = vehicles_in(recording);
  if (!wanted.empty()) {
    if (vehicles.count(wanted) > 0) return wanted;
    return Error{fmt::format("{}: has no topics of vehicle '{}'; its vehicles: {}",
                             recording.name(), wanted, listed(vehicles))};
  }
  if (vehicles.empty() || vehicles.count("") > 0) return std::string();
  if (vehicles.size() == 1) return *vehicles.begin();
  return Error{fmt::format("{}: is of several vehicles; choose one with --vehicle: {}",
                           recording.name(), listed(vehicles))};
}

}  // namespace swiftlet
