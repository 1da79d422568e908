// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "components/introspection/instances.hpp"
#include "components/runtime/message.hpp"
#include "components/runtime/names.hpp"

namespace swiftlet {
namespace {

using Json = nlohmann::ordered_json;

std::string health(const Instance& instance, Time now) {
  if (!instance.has_status) return "says nothing of itself";
  if (instance.silent(now)) {
    return fmt::format("not heard for {:.2f} s", to_seconds(now - instance.heard));
  }
  return instance.problems.empty() ? "ok" : fmt::format("{}", fmt::join(instance.problems, "; "));
}

bool is_end_of(const Endpoint& endpoint, const Instance& instance) {
  return endpoint.component == instance.component && endpoint.participant == instance.process &&
         !is_hidden(endpoint.topic);
}

/// Who is at the other side of an end of a topic.
std::vector<Endpoint> partners(const Endpoint& end, const GraphView& view) {
  std::vector<Endpoint> others;
  for (const Endpoint& endpoint : view.endpoints) {
    if (endpoint.topic == end.topic && endpoint.is_writer != end.is_writer) {
      others.push_back(endpoint);
    }
  }
  return others;
}

}  // namespace

std::string instances_text(const std::vector<Instance>& instances, const std::string& vehicle,
                           Time now) {
  std::vector<std::array<std::string, 4>> rows{{"COMPONENT", "PROCESS", "STATE", "HEALTH"}};
  for (const Instance& instance : instances) {
    rows.push_back(
        {instance.name(vehicle), instance.process, instance.state(now), health(instance, now)});
  }
  std::array<std::size_t, 3> widths{};
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < widths.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < widths.size(); ++i) {
      text += fmt::format("{:{}}  ", row[i], widths[i]);
    }
    text += row[3] + "\n";
  }
  return text;
}

Json instances_json(const std::vector<Instance>& instances, Time now) {
  Json array = Json::array();
  for (const Instance& instance : instances) {
    array.push_back({{"component", instance.component},
                     {"vehicle", instance.vehicle},
                     {"process", instance.process},
                     {"state", instance.state(now)},
                     {"active", instance.has_status && instance.active && !instance.silent(now)},
                     {"standby", instance.standby},
                     {"problems", instance.problems}});
  }
  return array;
}

std::string instance_text(const Instance& instance, const GraphView& view,
                          const std::string& vehicle, Time now) {
  std::string text = fmt::format("{} of process {}: {}, {}\n", instance.name(vehicle),
                                 instance.process, instance.state(now), health(instance, now));
  if (instance.has_status) {
    text += fmt::format("  in line {}, term {}, a sign of life every {:.0f} ms\n", instance.standby,
                        instance.term, to_seconds(instance.period) * 1e3);
  }
  for (const bool writes : {true, false}) {
    for (const Endpoint& end : view.endpoints) {
      if (!is_end_of(end, instance) || end.is_writer != writes) continue;
      const auto others = partners(end, view);
      text += fmt::format("  {} {} [{}] ({}) {} {}\n", writes ? "writes" : "reads ",
                          topic_of(vehicle, end.topic), ros_type_name(end.type), qos_text(end.qos),
                          writes ? "->" : "<-", others.empty() ? "nobody" : who(others));
    }
  }
  return text;
}

Json instance_json(const Instance& instance, const GraphView& view, const std::string& vehicle,
                   Time now) {
  Json json = instances_json({instance}, now)[0];
  json["term"] = instance.term;
  json["period_s"] = to_seconds(instance.period);
  json["writes"] = Json::array();
  json["reads"] = Json::array();
  for (const Endpoint& end : view.endpoints) {
    if (!is_end_of(end, instance)) continue;
    Json others = Json::array();
    for (const Endpoint& other : partners(end, view)) others.push_back(who(other));
    json[end.is_writer ? "writes" : "reads"].push_back(
        {{"topic", topic_of(vehicle, end.topic)},
         {"type", ros_type_name(end.type)},
         {"qos", qos_text(end.qos)},
         {end.is_writer ? "readers" : "writers", others}});
  }
  return json;
}

}  // namespace swiftlet
