// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/graph.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <optional>

#include "components/runtime/message.hpp"

namespace swiftlet {
namespace {

/// DDS 1.4, 2.2.3.13: names may be patterns; no name at all is the partition "".
bool share_partition(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  static const std::vector<std::string> no_name{""};
  for (const std::string& x : a.empty() ? no_name : a) {
    for (const std::string& y : b.empty() ? no_name : b) {
      if (fnmatch(x.c_str(), y.c_str(), 0) == 0 || fnmatch(y.c_str(), x.c_str(), 0) == 0) {
        return true;
      }
    }
  }
  return false;
}

std::string text_of(const std::vector<std::string>& partitions) {
  return partitions.empty() ? "the default one"
                            : fmt::format("'{}'", fmt::join(partitions, "', '"));
}

std::optional<Conflict> conflict_between(const Endpoint& a, const Endpoint& b) {
  if (a.topic != b.topic || a.is_writer == b.is_writer) return std::nullopt;
  const Endpoint& writer = a.is_writer ? a : b;
  const Endpoint& reader = a.is_writer ? b : a;
  if (writer.type != reader.type) {
    return Conflict{writer, reader,
                    fmt::format("type: written as {}, read as {}", ros_type_name(writer.type),
                                ros_type_name(reader.type))};
  }
  std::string problem = qos_conflict(writer.qos, reader.qos);
  if (problem.empty() && !share_partition(writer.partitions, reader.partitions)) {
    problem = fmt::format("partition: offered {}, requested {}", text_of(writer.partitions),
                          text_of(reader.partitions));
  }
  if (problem.empty()) return std::nullopt;
  return Conflict{writer, reader, problem};
}

std::string name_of(const Endpoint& endpoint) {
  return endpoint.component.empty()
             ? fmt::format("of process '{}'", endpoint.participant)
             : fmt::format("'{}' of process '{}'", endpoint.component, endpoint.participant);
}

}  // namespace

Graph::Graph(OnConflict on_conflict) : on_conflict_(std::move(on_conflict)) {}

void Graph::add(const Endpoint& endpoint) {
  std::vector<Conflict> found;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!endpoints_.insert_or_assign(endpoint.id, endpoint).second) return;
    for (const auto& [id, other] : endpoints_) {
      if (auto conflict = conflict_between(endpoint, other)) found.push_back(*conflict);
    }
  }
  for (const Conflict& conflict : found) on_conflict_(conflict);
}

void Graph::remove(const std::string& id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  endpoints_.erase(id);
}

std::vector<Endpoint> Graph::endpoints() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<Endpoint> endpoints;
  for (const auto& [id, endpoint] : endpoints_) endpoints.push_back(endpoint);
  return endpoints;
}

std::string Graph::component_of(const std::string& id) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = endpoints_.find(id);
  return found == endpoints_.end() ? "" : found->second.component;
}

std::vector<Conflict> Graph::conflicts() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<Conflict> conflicts;
  for (const auto& [writer_id, writer] : endpoints_) {
    if (!writer.is_writer) continue;
    for (const auto& [reader_id, reader] : endpoints_) {
      if (reader.is_writer) continue;
      if (auto conflict = conflict_between(writer, reader)) conflicts.push_back(*conflict);
    }
  }
  return conflicts;
}

std::map<std::string, Endpoint> weakest_offers(const std::vector<Endpoint>& endpoints) {
  std::map<std::string, Endpoint> offers;
  for (const Endpoint& endpoint : endpoints) {
    if (!endpoint.is_writer) continue;
    QosProfile& qos = offers.emplace(endpoint.topic, endpoint).first->second.qos;
    qos.reliable = qos.reliable && endpoint.qos.reliable;
    qos.transient_local = qos.transient_local && endpoint.qos.transient_local;
  }
  return offers;
}

std::string describe(const Conflict& conflict) {
  return fmt::format("topic '{}' does not flow from writer {} to reader {}: {}",
                     conflict.writer.topic, name_of(conflict.writer), name_of(conflict.reader),
                     conflict.problem);
}

}  // namespace swiftlet
