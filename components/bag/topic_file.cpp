// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/topic_file.hpp"

#include <fmt/format.h>

#include "components/runtime/reflection/idl_schema.hpp"

namespace swiftlet {
namespace {

/// What rosbag2 writes for a reliable topic with a queue of 10.
constexpr const char* kQosProfile =
    "- history: 1\n  depth: 10\n  reliability: 1\n  durability: 2\n"
    "  deadline:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  liveliness: 1\n"
    "  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  avoid_ros_namespace_conventions: false";

}  // namespace

Result<std::uint16_t> add_topic(mcap::Writer& writer, const std::string& topic,
                                const std::string& type) {
  const auto text = idl_schema(type);
  if (!text.ok()) return text.error();
  const auto schema = writer.add_schema(type, "ros2idl", std::string_view(*text));
  if (!schema.ok()) return schema.error();
  return writer.add_channel(topic, "cdr", *schema, {{"offered_qos_profiles", kQosProfile}});
}

Result<Cdr> last_bytes(const Recording& recording, const std::string& topic,
                       const std::string& type) {
  mcap::Filter filter;
  filter.topics = {topic};
  RecordingCursor cursor = recording.messages(filter);
  std::optional<Cdr> last;
  for (;;) {
    const auto next = cursor.next();
    if (!next.ok()) return next.error();
    if (!*next) break;
    const mcap::MessageView& view = **next;
    const std::string found = view.schema != nullptr ? view.schema->name : "none";
    if (found != type) {
      return Error{
          fmt::format("{}: {} has the type {}, not {}", recording.name(), topic, found, type)};
    }
    last = view.message.data.copy();
  }
  if (!last) return Error{fmt::format("{}: no message on {}", recording.name(), topic)};
  return *last;
}

}  // namespace swiftlet
