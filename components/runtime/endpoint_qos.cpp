// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/endpoint_qos.hpp"

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

/// Settings that a reader and a writer have in common.
template <class Qos>
void apply_profile(const EndpointSpec& spec, bool shared, Qos& qos) {
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
  if (shared) {
    qos.data_sharing().automatic();
  } else {
    qos.data_sharing().off();
  }
  qos.user_data().setValue({spec.component.begin(), spec.component.end()});
}

}  // namespace

dds::DataWriterQos writer_qos(const EndpointSpec& spec, bool shared, bool isolated) {
  dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
  apply_profile(spec, shared, qos);
  if (is_plain(spec)) qos.resource_limits().extra_samples = kSpareFrames;
  // Fragments of large samples need a sending thread; within one process nothing is sent.
  const bool asynchronous = spec.qos.large && !isolated && !shared;
  qos.publish_mode().kind =
      asynchronous ? dds::ASYNCHRONOUS_PUBLISH_MODE : dds::SYNCHRONOUS_PUBLISH_MODE;
  qos.reliable_writer_qos().times.heartbeatPeriod = Duration_t(0, 100'000'000);
  // A writer waits at most this long for a reliable reader that does not keep up.
  qos.reliability().max_blocking_time = Duration_t(0, 20'000'000);
  return qos;
}

dds::DataReaderQos reader_qos(const EndpointSpec& spec, bool shared) {
  dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
  apply_profile(spec, shared, qos);
  return qos;
}

}  // namespace swiftlet
