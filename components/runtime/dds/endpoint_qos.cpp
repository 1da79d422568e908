// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/endpoint_qos.hpp"

#include <algorithm>

namespace swiftlet {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::Duration_t;

namespace {

/// Payloads that wait beside the history of a writer of frames: a frame stays as it is until that
/// many more were written, which is the time that a callback has for it.
constexpr int kSpareFrames = 4;

bool is_plain(const EndpointSpec& spec) {
  const MessageType* type = find_message_type(spec.type);
  return type != nullptr && type->plain_size() > 0;
}

/// A writer with a lease announces itself that often within one.
constexpr int kAnnouncementsPerLease = 3;

Duration_t to_dds(Duration duration) {
  if (duration == kUnlimited) return eprosima::fastrtps::c_TimeInfinite;
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(duration);
  return {static_cast<std::int32_t>(seconds.count()),
          static_cast<std::uint32_t>((duration - seconds).count())};
}

Duration from_dds(const Duration_t& duration) {
  if (duration == eprosima::fastrtps::c_TimeInfinite) return kUnlimited;
  return std::chrono::seconds(duration.seconds) + std::chrono::nanoseconds(duration.nanosec);
}

template <class Qos>
int depth_of(const Qos& qos) {
  return qos.history().kind == dds::KEEP_ALL_HISTORY_QOS ? qos.resource_limits().max_samples
                                                         : qos.history().depth;
}

/// Settings that a reader and a writer have in common.
template <class Qos>
void apply_profile(const EndpointSpec& spec, const EndpointPlace& place, Qos& qos) {
  qos.reliability().kind =
      spec.qos.reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind =
      spec.qos.transient_local ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = spec.qos.depth;
  qos.resource_limits().max_instances = 1;
  qos.resource_limits().max_samples = spec.qos.depth;
  qos.resource_limits().max_samples_per_instance = spec.qos.depth;
  // Those of plain types are large at once.
  qos.resource_limits().allocated_samples = std::min(spec.qos.depth, is_plain(spec) ? 1 : 8);
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  // Not `on`: readers on other hosts, and those of other programs that do not share, get copies.
  if (place.shared) {
    qos.data_sharing().automatic();
  } else {
    qos.data_sharing().off();
  }
  // Deadline, lifespan and the like: what was discovered of a writer is asked of it, by a recorder.
  qos.deadline().period = to_dds(spec.qos.deadline);
  qos.lifespan().duration = to_dds(spec.qos.lifespan);
  qos.latency_budget().duration = to_dds(spec.qos.latency_budget);
  qos.liveliness().kind = static_cast<dds::LivelinessQosPolicyKind>(spec.qos.liveliness);
  qos.liveliness().lease_duration = to_dds(spec.qos.lease);
  if (spec.qos.lease != kUnlimited) {
    qos.liveliness().announcement_period = to_dds(spec.qos.lease / kAnnouncementsPerLease);
  }
  qos.ownership().kind =
      spec.qos.exclusive ? dds::EXCLUSIVE_OWNERSHIP_QOS : dds::SHARED_OWNERSHIP_QOS;
}

/// What follows from all policies, the user's included.
template <class Qos>
void finish(const EndpointSpec& spec, Qos& qos) {
  const std::string text = announcement(spec.component, depth_of(qos));
  qos.user_data().setValue({text.begin(), text.end()});
}

/// Policies that DataWriterQos and DataReaderQos have under the same name.
template <class Qos>
QosProfile common_profile(const Qos& qos, const QosProfile& profile) {
  QosProfile result = profile;
  result.reliable = qos.reliability().kind == dds::RELIABLE_RELIABILITY_QOS;
  result.transient_local = qos.durability().kind >= dds::TRANSIENT_LOCAL_DURABILITY_QOS;
  result.depth = depth_of(qos);
  result.deadline = from_dds(qos.deadline().period);
  result.lifespan = from_dds(qos.lifespan().duration);
  result.latency_budget = from_dds(qos.latency_budget().duration);
  result.liveliness = static_cast<Liveliness>(qos.liveliness().kind);
  result.lease = from_dds(qos.liveliness().lease_duration);
  result.exclusive = qos.ownership().kind == dds::EXCLUSIVE_OWNERSHIP_QOS;
  result.by_source_time =
      qos.destination_order().kind == dds::BY_SOURCE_TIMESTAMP_DESTINATIONORDER_QOS;
  return result;
}

/// The same for what discovery tells.
template <class Qos>
QosProfile common_discovered(const Qos& qos) {
  QosProfile result{"discovered", false, false, 0, false};
  result.reliable = qos.m_reliability.kind == dds::RELIABLE_RELIABILITY_QOS;
  result.transient_local = qos.m_durability.kind >= dds::TRANSIENT_LOCAL_DURABILITY_QOS;
  result.depth = read_announcement(qos.m_userData.data_vec()).depth;
  result.deadline = from_dds(qos.m_deadline.period);
  result.lifespan = from_dds(qos.m_lifespan.duration);
  result.latency_budget = from_dds(qos.m_latencyBudget.duration);
  result.liveliness = static_cast<Liveliness>(qos.m_liveliness.kind);
  result.lease = from_dds(qos.m_liveliness.lease_duration);
  result.exclusive = qos.m_ownership.kind == dds::EXCLUSIVE_OWNERSHIP_QOS;
  result.by_source_time =
      qos.m_destinationOrder.kind == dds::BY_SOURCE_TIMESTAMP_DESTINATIONORDER_QOS;
  return result;
}

}  // namespace

dds::DataWriterQos writer_qos(const EndpointSpec& spec, const EndpointPlace& place,
                              const QosOverrides* overrides) {
  dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
  apply_profile(spec, place, qos);
  qos.ownership_strength().value = static_cast<std::uint32_t>(spec.qos.strength);
  if (is_plain(spec)) qos.resource_limits().extra_samples = kSpareFrames;
  // Neither a slow link nor a reliable reader that does not keep up must hold up who writes a large
  // sample: a thread of its own waits for them. For frames on one machine, where nobody waits, that
  // thread would only add its delay, which is as much again as all others.
  const bool somebody_waits = place.leaves_machine || (spec.qos.reliable && !place.isolated);
  const bool asynchronous = spec.qos.large && somebody_waits && !place.shared;
  qos.publish_mode().kind =
      asynchronous ? dds::ASYNCHRONOUS_PUBLISH_MODE : dds::SYNCHRONOUS_PUBLISH_MODE;
  qos.reliable_writer_qos().times.heartbeatPeriod = Duration_t(0, 100'000'000);
  // Fast DDS wakes its event thread before it sends a reliable sample, to end the suppression of
  // NACKs; by default, zero, at once and for each sample, which costs a quarter of the latency.
  // This is one wake-up for all samples of that time, well below the heartbeat period, so that a
  // lost sample is repaired as soon as before.
  qos.reliable_writer_qos().times.nackSupressionDuration = Duration_t(0, 20'000'000);
  // A writer waits at most this long for a reliable reader that does not keep up.
  qos.reliability().max_blocking_time = Duration_t(0, 20'000'000);
  // DDS's timers run on wall time, which a run in lockstep has nothing to do with.
  if (place.isolated) qos.deadline().period = eprosima::fastrtps::c_TimeInfinite;
  if (overrides != nullptr) overrides->apply(spec.topic, spec.qos.name, qos);
  finish(spec, qos);
  return qos;
}

dds::DataReaderQos reader_qos(const EndpointSpec& spec, const EndpointPlace& place,
                              const QosOverrides* overrides) {
  dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
  apply_profile(spec, place, qos);
  if (overrides != nullptr) overrides->apply(spec.topic, spec.qos.name, qos);
  finish(spec, qos);
  return qos;
}

QosProfile profile_of(const dds::DataWriterQos& qos, const QosProfile& profile) {
  QosProfile result = common_profile(qos, profile);
  result.strength = static_cast<int>(qos.ownership_strength().value);
  return result;
}
QosProfile profile_of(const dds::DataReaderQos& qos, const QosProfile& profile) {
  return common_profile(qos, profile);
}
QosProfile discovered_profile(const dds::WriterQos& qos) {
  QosProfile result = common_discovered(qos);
  result.strength = static_cast<int>(qos.m_ownershipStrength.value);
  return result;
}
QosProfile discovered_profile(const dds::ReaderQos& qos) {
  return common_discovered(qos);
}

namespace {

const std::string kComponentKey = "component=";
const std::string kDepthKey = "depth=";

/// What stands behind `key` up to the next semicolon.
std::string value_of(const std::string& text, const std::string& key) {
  const std::size_t at = text.find(key);
  if (at == std::string::npos || (at > 0 && text[at - 1] != ';')) return "";
  const std::size_t begin = at + key.size();
  return text.substr(begin, text.find(';', begin) - begin);
}

}  // namespace

std::string announcement(const std::string& component, int depth) {
  return kComponentKey + component + ";" + kDepthKey + std::to_string(depth) + ";";
}

Announcement read_announcement(const std::vector<std::uint8_t>& user_data) {
  const std::string text(user_data.begin(), user_data.end());
  Announcement result;
  result.component = value_of(text, kComponentKey);
  const std::string depth = value_of(text, kDepthKey);
  // Any program may write anything here.
  const bool is_number = !depth.empty() && depth.size() < 10 &&
                         depth.find_first_not_of("0123456789") == std::string::npos;
  if (is_number) result.depth = std::stoi(depth);
  return result;
}

}  // namespace swiftlet
