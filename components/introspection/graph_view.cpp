// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/graph_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "components/runtime/config/config.hpp"
#include "components/runtime/message.hpp"
#include "components/runtime/names.hpp"

namespace swiftlet {
namespace {

constexpr const char* kAnnouncer = "node_announcer";

void clean(Endpoint& endpoint) {
  // rmw of ROS 2 puts "typehash=RIHS01_..." there.
  if (!check_name(endpoint.component).ok()) endpoint.component.clear();
}

std::string without_slash(const std::string& name) {
  return name.substr(!name.empty() && name[0] == '/' ? 1 : 0);
}

void note_type(TopicView& topic, const Endpoint& endpoint) {
  const std::string type = ros_type_name(endpoint.type);
  auto& types = topic.types;
  if (std::find(types.begin(), types.end(), type) != types.end()) return;
  // What is written comes first: that is what can be read.
  types.insert(endpoint.is_writer ? types.begin() : types.end(), type);
}

}  // namespace

GraphView view_of(const Graph& graph, const std::string& component, const std::string& process) {
  const auto is_own = [&](const Endpoint& endpoint) {
    return endpoint.participant == process &&
           (endpoint.component == component || endpoint.component == kAnnouncer);
  };
  GraphView view;
  for (Endpoint& endpoint : graph.endpoints()) {
    if (is_own(endpoint)) continue;
    clean(endpoint);
    view.endpoints.push_back(std::move(endpoint));
  }
  for (Conflict& conflict : graph.conflicts()) {
    if (is_own(conflict.writer) || is_own(conflict.reader)) continue;
    clean(conflict.writer);
    clean(conflict.reader);
    view.conflicts.push_back(std::move(conflict));
  }
  std::sort(view.endpoints.begin(), view.endpoints.end(), [](const Endpoint& a, const Endpoint& b) {
    return std::tie(a.component, a.participant, a.topic, a.id) <
           std::tie(b.component, b.participant, b.topic, b.id);
  });
  return view;
}

std::vector<TopicView> topics_of(const GraphView& view, const std::string& vehicle) {
  std::map<std::string, TopicView> topics;
  for (const Endpoint& endpoint : view.endpoints) {
    const std::string name = topic_of(vehicle, endpoint.topic);
    if (!vehicle.empty() && wire_topic(vehicle, name) != endpoint.topic) continue;
    TopicView& topic = topics[name];
    topic.wire = endpoint.topic;
    topic.name = name;
    note_type(topic, endpoint);
    (endpoint.is_writer ? topic.writers : topic.readers).push_back(endpoint);
  }
  for (const Conflict& conflict : view.conflicts) {
    const auto found = topics.find(topic_of(vehicle, conflict.writer.topic));
    if (found != topics.end()) found->second.conflicts.push_back(conflict);
  }
  std::vector<TopicView> all;
  for (auto& [name, topic] : topics) all.push_back(std::move(topic));
  return all;
}

Result<TopicView> find_topic(const GraphView& view, const std::string& vehicle,
                             const std::string& name) {
  const std::string plain = without_slash(name);
  const auto all = topics_of(view, "");
  for (const std::string& wire : {wire_topic(vehicle, plain), wire_topic("", plain), name}) {
    for (const TopicView& topic : all) {
      if (topic.wire == wire) return topic;
    }
  }
  std::vector<std::string> known;
  for (const TopicView& topic : all) {
    if (!is_hidden(topic.wire)) known.push_back(topic_of(vehicle, topic.wire));
  }
  if (known.empty())
    return Error{fmt::format("nobody writes or reads '{}', or anything else", name)};
  const std::string near = nearest_word(plain, known);
  return Error{fmt::format(
      "nobody writes or reads '{}'; {}", name,
      near.empty() ? "see swiftlet topic list" : fmt::format("did you mean '{}'?", near))};
}

bool is_hidden(const std::string& wire_topic) {
  for (const char* prefix : {"rq/", "rr/", "rs/", "ra/", "rp/"}) {
    if (wire_topic.compare(0, 3, prefix) == 0) return true;
  }
  return wire_topic == "ros_discovery_info" || wire_topic.find("/alive/") != std::string::npos;
}

std::string who(const Endpoint& endpoint) {
  return endpoint.component.empty()
             ? fmt::format("process {}", endpoint.participant)
             : fmt::format("{} of process {}", endpoint.component, endpoint.participant);
}

std::string who(const std::vector<Endpoint>& endpoints) {
  std::string text;
  for (const Endpoint& endpoint : endpoints) text += (text.empty() ? "" : ", ") + who(endpoint);
  return text;
}

std::string qos_text(const QosProfile& qos) {
  return fmt::format("{}, {}", qos.reliable ? "reliable" : "best effort",
                     qos.transient_local ? "transient local" : "volatile");
}

}  // namespace swiftlet
