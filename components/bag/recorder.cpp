// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/runtime/names.hpp"
#include "components/runtime/reflection/idl_schema.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

/// Samples of a topic that wait while the disk is slow: half a second of the fastest sensor.
constexpr int kDepth = 512;

/// What a recording calls a topic; nothing where it is not of this vehicle.
std::optional<std::string> topic_in_file(const std::string& vehicle, const std::string& wire) {
  std::string topic = topic_of(vehicle, wire);
  const bool is_own = vehicle.empty() || wire_topic(vehicle, topic) == wire;
  return is_own ? std::make_optional(std::move(topic)) : std::nullopt;
}

}  // namespace

Recorder::Recorder(const ComponentContext& context, const RecorderParams& params)
    : Component(context), params_(params) {
  mcap::WriterParams writer;
  writer.profile = "ros2";
  writer.overwrite = params.overwrite;
  Result<mcap::Writer> opened = mcap::Writer::open(params.file, writer);
  if (!opened.ok()) throw ConfigError(opened.error().reason);
  writer_.emplace(std::move(opened).value());
  for (std::string& topic : params_.topics) {
    if (topic[0] == '/') topic.erase(0, 1);
  }
  look_for_topics();
  every(100ms, [this](Time) { look_for_topics(); });
  every(1s, [this](Time) { check(writer_->flush()); });
}

Status Recorder::close() {
  return writer_->close();
}

std::vector<std::string> Recorder::missing() const {
  std::vector<std::string> missing;
  for (const std::string& wanted : params_.topics) {
    const bool found = std::any_of(recorded_.begin(), recorded_.end(),
                                   [&](const auto& entry) { return entry.second == wanted; });
    if (!found) missing.push_back(wanted);
  }
  return missing;
}

void Recorder::look_for_topics() {
  for (const auto& [wire, endpoint] : weakest_offers(context().participant->graph().endpoints())) {
    if (recorded_.count(wire) != 0) continue;
    const auto topic = topic_in_file(context().vehicle, wire);
    if (!topic) continue;
    const auto& wanted = params_.topics;
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), *topic) != wanted.end()) {
      record(endpoint, *topic);
    }
  }
}

void Recorder::record(const Endpoint& endpoint, const std::string& topic) {
  recorded_.emplace(endpoint.topic, topic);
  const std::string type = ros_type_name(endpoint.type);
  const auto idl = idl_schema(type);
  if (!idl.ok()) {
    log()->warn("{} has the type {}, which this program does not know: recorded without its IDL",
                topic, type);
  }
  // MCAP's way to give a type's name alone is a schema without encoding.
  const auto schema =
      writer_->add_schema(type, idl.ok() ? "ros2idl" : "",
                          idl.ok() ? mcap::ByteView(std::string_view(*idl)) : mcap::ByteView());
  if (!schema.ok()) return check(schema.error());
  const auto channel = writer_->add_channel(topic, "cdr", *schema,
                                            {{"offered_qos_profiles", qos_metadata(endpoint.qos)}});
  if (!channel.ok()) return check(channel.error());
  // Ask for no more than is offered.
  QosProfile qos = endpoint.qos;
  qos.depth = std::max(qos.depth, kDepth);
  subscribe_raw(endpoint.topic, endpoint.type, qos,
                [this, id = *channel](const Cdr& cdr) { write(id, cdr); });
}

void Recorder::write(std::uint16_t channel, const Cdr& cdr) {
  mcap::Message message;
  message.channel_id = channel;
  message.sequence = sequence_[channel]++;
  message.log_time = mcap::to_timestamp(now());
  message.publish_time = message.log_time;
  message.data = cdr;
  check(writer_->write(message));
}

void Recorder::check(const Status& status) {
  if (status.ok()) return;
  log()->error("recording stopped: {}", status.error().reason);
  stop(1);
}

std::string qos_metadata(const QosProfile& qos) {
  // Numbers as rmw defines them. Infinite durations are rmw's, too.
  constexpr const char* kInfinite = "\n    sec: 9223372036\n    nsec: 854775807\n";
  return fmt::format(
      "- history: 1\n  depth: {}\n  reliability: {}\n  durability: {}\n  deadline:{}"
      "  lifespan:{}  liveliness: 1\n  liveliness_lease_duration:{}"
      "  avoid_ros_namespace_conventions: false",
      qos.depth, qos.reliable ? 1 : 2, qos.transient_local ? 1 : 2, kInfinite, kInfinite,
      kInfinite);
}

}  // namespace swiftlet
