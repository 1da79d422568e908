// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/bag/idl_schema.hpp"
#include "components/runtime/names.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

}  // namespace

Recorder::Recorder(const ComponentContext& context, const RecorderParams& params)
    : Component(context), params_(params) {
  mcap::WriterParams writer;
  writer.profile = "ros2";
  writer.overwrite = params.overwrite;
  Result<mcap::Writer> opened = mcap::Writer::open(params.file, writer);
  if (!opened.ok()) throw ConfigError(opened.error().reason);
  writer_.emplace(std::move(opened).value());
  look_for_topics();
  every(100ms, [this](Time) { look_for_topics(); });
  every(1s, [this](Time) { check(writer_->flush()); });
}

Status Recorder::close() {
  return writer_->close();
}

void Recorder::look_for_topics() {
  for (const Endpoint& endpoint : context().participant->graph().endpoints()) {
    if (!endpoint.is_writer || recorded_.count(endpoint.topic) != 0) continue;
    const std::string topic = topic_of("", endpoint.topic);
    const auto& wanted = params_.topics;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), topic) == wanted.end()) continue;
    record(endpoint);
  }
}

void Recorder::record(const Endpoint& endpoint) {
  recorded_.insert(endpoint.topic);
  const std::string type = ros_type_name(endpoint.type);
  std::uint16_t schema_id = 0;
  if (const auto schema = idl_schema(type); schema.ok()) {
    const auto id = writer_->add_schema(type, "ros2idl", std::string_view(*schema));
    if (!id.ok()) return check(id.error());
    schema_id = *id;
  } else {
    log()->warn("{} has the type {}, which this program does not know: recorded without schema",
                endpoint.topic, type);
  }
  const auto channel = writer_->add_channel(topic_of("", endpoint.topic), "cdr", schema_id,
                                            {{"offered_qos_profiles", qos_metadata(endpoint.qos)}});
  if (!channel.ok()) return check(channel.error());
  // Ask for no more than is offered, and keep enough for bursts.
  QosProfile qos = endpoint.qos;
  qos.depth = std::max(qos.depth, 64);
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
