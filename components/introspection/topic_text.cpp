// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/topic_text.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "components/runtime/message.hpp"

namespace swiftlet {
namespace {

using Json = nlohmann::ordered_json;

std::string count_text(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string ends_text(const char* title, const std::vector<Endpoint>& ends, bool verbose) {
  std::string text = fmt::format("{}: {}\n", title, ends.size());
  for (const Endpoint& end : ends) {
    text += fmt::format("  {}: {}\n", who(end), qos_text(end.qos));
    if (!verbose) continue;
    text += fmt::format("    type  {}\n    id    {}\n", ros_type_name(end.type), end.id);
    if (end.qos.depth > 0) text += fmt::format("    depth {}\n", end.qos.depth);
  }
  return text;
}

Json ends_json(const std::vector<Endpoint>& ends) {
  Json array = Json::array();
  for (const Endpoint& end : ends) {
    array.push_back({{"component", end.component},
                     {"process", end.participant},
                     {"id", end.id},
                     {"type", ros_type_name(end.type)},
                     {"reliable", end.qos.reliable},
                     {"transient_local", end.qos.transient_local},
                     {"depth", end.qos.depth}});
  }
  return array;
}

}  // namespace

std::string list_text(const std::vector<TopicView>& topics, const TopicListOptions& options) {
  std::string text;
  for (const TopicView& topic : topics) {
    if (!options.all && is_hidden(topic.wire)) continue;
    text += topic.name;
    if (options.types) text += fmt::format(" [{}]", fmt::join(topic.types, ", "));
    if (options.counts) {
      text += fmt::format(": {}, {}", count_text(topic.writers.size(), "writer"),
                          count_text(topic.readers.size(), "reader"));
      if (!topic.conflicts.empty()) {
        text += ", " + count_text(topic.conflicts.size(), "conflict");
      }
    }
    text += "\n";
  }
  return text;
}

Json list_json(const std::vector<TopicView>& topics, bool all) {
  Json array = Json::array();
  for (const TopicView& topic : topics) {
    if (!all && is_hidden(topic.wire)) continue;
    array.push_back({{"name", topic.name},
                     {"types", topic.types},
                     {"writers", topic.writers.size()},
                     {"readers", topic.readers.size()},
                     {"conflicts", topic.conflicts.size()}});
  }
  return array;
}

std::string info_text(const TopicView& topic, bool verbose) {
  std::string text = fmt::format("Topic: {} ({} on the wire)\nType: {}\n", topic.name, topic.wire,
                                 fmt::join(topic.types, ", "));
  text += ends_text("Writers", topic.writers, verbose);
  text += ends_text("Readers", topic.readers, verbose);
  for (const Conflict& conflict : topic.conflicts) {
    text += fmt::format("CONFLICT: nothing flows from {} to {}: {}\n", who(conflict.writer),
                        who(conflict.reader), conflict.problem);
  }
  return text;
}

Json info_json(const TopicView& topic) {
  Json conflicts = Json::array();
  for (const Conflict& conflict : topic.conflicts) {
    conflicts.push_back({{"writer", who(conflict.writer)},
                         {"reader", who(conflict.reader)},
                         {"problem", conflict.problem}});
  }
  return {{"name", topic.name},
          {"wire", topic.wire},
          {"types", topic.types},
          {"writers", ends_json(topic.writers)},
          {"readers", ends_json(topic.readers)},
          {"conflicts", conflicts}};
}

}  // namespace swiftlet
