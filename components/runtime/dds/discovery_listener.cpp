// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/discovery_listener.hpp"

#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>

#include <sstream>

#include "components/runtime/dds/endpoint_qos.hpp"

namespace swiftlet {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

namespace {

/// ReaderProxyData and WriterProxyData have the same accessors without a common base.
template <class ProxyData>
Endpoint endpoint_of(const ProxyData& data, bool is_writer) {
  Endpoint endpoint;
  endpoint.id = id_of(data.guid());
  endpoint.topic = data.topicName().to_string();
  endpoint.type = data.typeName().to_string();
  endpoint.is_writer = is_writer;
  endpoint.qos = discovered_profile(data.m_qos);
  endpoint.component = read_announcement(data.m_qos.m_userData.data_vec()).component;
  endpoint.partitions = data.m_qos.m_partition.getNames();
  return endpoint;
}

}  // namespace

std::string id_of(const rtps::GUID_t& guid) {
  std::ostringstream text;
  text << guid;
  return text.str();
}

std::string prefix_of(const rtps::GUID_t& guid) {
  std::ostringstream text;
  text << guid.guidPrefix;
  return text.str();
}

void DiscoveryListener::on_participant_discovery(dds::DomainParticipant*,
                                                 rtps::ParticipantDiscoveryInfo&& info) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool gone = info.status == rtps::ParticipantDiscoveryInfo::REMOVED_PARTICIPANT ||
                    info.status == rtps::ParticipantDiscoveryInfo::DROPPED_PARTICIPANT;
  if (gone) {
    names_.erase(prefix_of(info.info.m_guid));
  } else {
    names_[prefix_of(info.info.m_guid)] = info.info.m_participantName.to_string();
  }
}

void DiscoveryListener::on_subscriber_discovery(dds::DomainParticipant*,
                                                rtps::ReaderDiscoveryInfo&& info) {
  if (info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER) {
    graph_.remove(id_of(info.info.guid()));
    return;
  }
  Endpoint endpoint = endpoint_of(info.info, false);
  endpoint.participant = participant_name(info.info.guid());
  graph_.add(endpoint);
}

void DiscoveryListener::on_publisher_discovery(dds::DomainParticipant*,
                                               rtps::WriterDiscoveryInfo&& info) {
  if (info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER) {
    graph_.remove(id_of(info.info.guid()));
    return;
  }
  Endpoint endpoint = endpoint_of(info.info, true);
  endpoint.participant = participant_name(info.info.guid());
  graph_.add(endpoint);
}

std::string DiscoveryListener::participant_name(const rtps::GUID_t& guid) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = names_.find(prefix_of(guid));
  return found == names_.end() ? prefix_of(guid) : found->second;
}

}  // namespace swiftlet
