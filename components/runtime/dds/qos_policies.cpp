// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/qos_policies.hpp"

#include <algorithm>

namespace swiftlet {

namespace dds = eprosima::fastdds::dds;
using eprosima::fastrtps::PublisherAttributes;
using eprosima::fastrtps::SubscriberAttributes;

namespace {

eprosima::fastrtps::Duration_t third_of(const eprosima::fastrtps::Duration_t& duration) {
  if (duration == eprosima::fastrtps::c_TimeInfinite) return duration;
  const std::int64_t ns = duration.to_ns() / 3;
  constexpr std::int64_t kSecond = 1'000'000'000;
  return {static_cast<std::int32_t>(ns / kSecond), static_cast<std::uint32_t>(ns % kSecond)};
}

/// What writers and readers have in common. Where the depth changes, so do the limits that follow
/// from it; limits that stand in the file come later in the alphabet, and win.
template <class A, class Q>
Policies<A, Q> common_policies() {
  const auto set_depth = [](int depth, Q& qos) {
    qos.history().depth = depth;
    qos.resource_limits().max_samples = depth;
    qos.resource_limits().max_samples_per_instance = depth;
    qos.resource_limits().allocated_samples =
        std::min(depth, qos.resource_limits().allocated_samples);
  };
  return {
      {"historyMemoryPolicy",
       [](const A& a, Q& q) { q.endpoint().history_memory_policy = a.historyMemoryPolicy; }},
      {"qos/data_sharing/kind",
       [](const A& a, Q& q) {
         if (a.qos.data_sharing.kind() == dds::DataSharingKind::OFF) q.data_sharing().off();
       }},
      {"qos/deadline/period",
       [](const A& a, Q& q) { q.deadline().period = a.qos.m_deadline.period; }},
      {"qos/durability/kind",
       [](const A& a, Q& q) { q.durability().kind = a.qos.m_durability.kind; }},
      {"qos/latencyBudget/duration",
       [](const A& a, Q& q) { q.latency_budget().duration = a.qos.m_latencyBudget.duration; }},
      {"qos/lifespan/duration",
       [](const A& a, Q& q) { q.lifespan().duration = a.qos.m_lifespan.duration; }},
      {"qos/liveliness/announcement_period",
       [](const A& a, Q& q) {
         q.liveliness().announcement_period = a.qos.m_liveliness.announcement_period;
       }},
      {"qos/liveliness/kind",
       [](const A& a, Q& q) { q.liveliness().kind = a.qos.m_liveliness.kind; }},
      {"qos/liveliness/lease_duration",
       [](const A& a, Q& q) {
         auto& liveliness = q.liveliness();
         liveliness.lease_duration = a.qos.m_liveliness.lease_duration;
         // Fast DDS wants a writer to announce itself within the lease; where the file has no
         // period that does, it follows from the lease.
         if (liveliness.announcement_period >= liveliness.lease_duration) {
           liveliness.announcement_period = third_of(liveliness.lease_duration);
         }
       }},
      {"qos/ownership/kind", [](const A& a, Q& q) { q.ownership().kind = a.qos.m_ownership.kind; }},
      {"qos/reliability/kind",
       [](const A& a, Q& q) { q.reliability().kind = a.qos.m_reliability.kind; }},
      {"qos/reliability/max_blocking_time",
       [](const A& a, Q& q) {
         q.reliability().max_blocking_time = a.qos.m_reliability.max_blocking_time;
       }},
      {"topic/historyQos/depth",
       [set_depth](const A& a, Q& q) { set_depth(a.topic.historyQos.depth, q); }},
      {"topic/historyQos/kind",
       [](const A& a, Q& q) { q.history().kind = a.topic.historyQos.kind; }},
      {"topic/resourceLimitsQos/allocated_samples",
       [](const A& a, Q& q) {
         q.resource_limits().allocated_samples = a.topic.resourceLimitsQos.allocated_samples;
       }},
      {"topic/resourceLimitsQos/extra_samples",
       [](const A& a, Q& q) {
         q.resource_limits().extra_samples = a.topic.resourceLimitsQos.extra_samples;
       }},
      {"topic/resourceLimitsQos/max_samples",
       [](const A& a, Q& q) {
         q.resource_limits().max_samples = a.topic.resourceLimitsQos.max_samples;
       }},
      {"topic/resourceLimitsQos/max_samples_per_instance",
       [](const A& a, Q& q) {
         q.resource_limits().max_samples_per_instance =
             a.topic.resourceLimitsQos.max_samples_per_instance;
       }},
      {kPartitionPolicy, [](const A&, Q&) {}},
  };
}

}  // namespace

const Policies<PublisherAttributes, dds::DataWriterQos>& writer_policies() {
  using A = PublisherAttributes;
  using Q = dds::DataWriterQos;
  static const Policies<A, Q> policies = [] {
    auto all = common_policies<A, Q>();
    all["qos/ownershipStrength/value"] = [](const A& a, Q& q) {
      q.ownership_strength().value = a.qos.m_ownershipStrength.value;
    };
    all["qos/publishMode/kind"] = [](const A& a, Q& q) {
      q.publish_mode().kind = a.qos.m_publishMode.kind;
    };
    all["times/heartbeatPeriod"] = [](const A& a, Q& q) {
      q.reliable_writer_qos().times.heartbeatPeriod = a.times.heartbeatPeriod;
    };
    all["times/initialHeartbeatDelay"] = [](const A& a, Q& q) {
      q.reliable_writer_qos().times.initialHeartbeatDelay = a.times.initialHeartbeatDelay;
    };
    all["times/nackResponseDelay"] = [](const A& a, Q& q) {
      q.reliable_writer_qos().times.nackResponseDelay = a.times.nackResponseDelay;
    };
    all["times/nackSupressionDuration"] = [](const A& a, Q& q) {
      q.reliable_writer_qos().times.nackSupressionDuration = a.times.nackSupressionDuration;
    };
    return all;
  }();
  return policies;
}

const Policies<SubscriberAttributes, dds::DataReaderQos>& reader_policies() {
  using A = SubscriberAttributes;
  using Q = dds::DataReaderQos;
  static const Policies<A, Q> policies = [] {
    auto all = common_policies<A, Q>();
    all["expectsInlineQos"] = [](const A& a, Q& q) { q.expects_inline_qos(a.expectsInlineQos); };
    all["times/heartbeatResponseDelay"] = [](const A& a, Q& q) {
      q.reliable_reader_qos().times.heartbeatResponseDelay = a.times.heartbeatResponseDelay;
    };
    all["times/initialAcknackDelay"] = [](const A& a, Q& q) {
      q.reliable_reader_qos().times.initialAcknackDelay = a.times.initialAcknackDelay;
    };
    return all;
  }();
  return policies;
}

}  // namespace swiftlet
