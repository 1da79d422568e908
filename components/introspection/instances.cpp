// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/instances.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "components/runtime/message.hpp"
#include "components/runtime/names.hpp"
#include "components/runtime/topic.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

/// A busy computer may be late with a few signs of life.
constexpr Duration kPatience = 250ms;

}  // namespace

std::string Instance::name(const std::string& seen_from) const {
  return vehicle.empty() || vehicle == seen_from ? component : vehicle + "/" + component;
}

bool Instance::silent(Time now) const {
  return has_status && now - heard > std::max(3 * period, kPatience);
}

std::string Instance::state(Time now) const {
  if (!has_status) return "-";
  if (silent(now)) return "silent";
  return active ? "active" : fmt::format("standby {}", standby);
}

bool InstanceBook::Key::operator<(const Key& other) const {
  return std::tie(vehicle, component, process) <
         std::tie(other.vehicle, other.component, other.process);
}

bool is_status_topic(const std::string& wire, std::string* vehicle) {
  const std::string topic = topic_of("", wire);
  for (const std::string& mark :
       {std::string(topic::component_status.name), topic::alive_name("")}) {
    const std::size_t at = topic.rfind(mark);
    const bool at_start = at == 0 || (at != std::string::npos && topic[at - 1] == '/');
    // A sign of life has the component's name behind it, a status nothing.
    const bool at_end = mark.back() == '/' || at + mark.size() == topic.size();
    if (!at_start || !at_end) continue;
    if (vehicle != nullptr) *vehicle = topic.substr(0, at == 0 ? 0 : at - 1);
    return true;
  }
  return false;
}

void InstanceBook::note(const std::string& wire, const Cdr& cdr, Time now) {
  std::string vehicle;
  if (!is_status_topic(wire, &vehicle)) return;
  const auto decoded = from_cdr<swiftlet_msgs::msg::ComponentStatus>(cdr);
  if (!decoded.ok()) return;
  const auto& status = *decoded;
  Instance& instance = said_[{vehicle, status.component_name(), status.process()}];
  instance.vehicle = vehicle;
  instance.component = status.component_name();
  instance.process = status.process();
  instance.has_status = true;
  instance.active = status.active();
  instance.standby = static_cast<int>(status.standby());
  instance.term = status.term();
  const double period = status.period();
  instance.period = period > 0.0 && period < 3600.0 ? from_seconds(period) : Duration(0);
  instance.heard = now;
  const bool is_status = topic_of(vehicle, wire) == topic::component_status.name;
  if (is_status) instance.problems = status.problems();
}

std::vector<Instance> InstanceBook::all(const GraphView& view, const std::string& vehicle) const {
  std::map<Key, Instance> found;
  for (const auto& [key, instance] : said_) {
    if (vehicle.empty() || instance.vehicle == vehicle) found.emplace(key, instance);
  }
  const auto is_known = [&](const Endpoint& endpoint) {
    return std::any_of(found.begin(), found.end(), [&](const auto& entry) {
      return entry.second.component == endpoint.component &&
             entry.second.process == endpoint.participant;
    });
  };
  for (const Endpoint& endpoint : view.endpoints) {
    const bool of_vehicle =
        vehicle.empty() || wire_topic(vehicle, topic_of(vehicle, endpoint.topic)) == endpoint.topic;
    // What announces nodes to ROS 2 is part of every process.
    const bool infrastructure = endpoint.topic == "ros_discovery_info";
    if (endpoint.component.empty() || !of_vehicle || infrastructure || is_known(endpoint)) continue;
    Instance instance;
    instance.vehicle = vehicle;
    instance.component = endpoint.component;
    instance.process = endpoint.participant;
    found.emplace(Key{vehicle, endpoint.component, endpoint.participant}, instance);
  }
  std::vector<Instance> all;
  for (const auto& [key, instance] : found) all.push_back(instance);
  std::stable_sort(all.begin(), all.end(), [](const Instance& a, const Instance& b) {
    return std::make_tuple(a.vehicle, a.component, !a.active, a.standby) <
           std::make_tuple(b.vehicle, b.component, !b.active, b.standby);
  });
  return all;
}

}  // namespace swiftlet
