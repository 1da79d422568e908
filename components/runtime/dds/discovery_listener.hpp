// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <map>
#include <mutex>
#include <string>

#include "components/runtime/graph.hpp"

namespace swiftlet {

/// Endpoint::id of a GUID.
std::string id_of(const eprosima::fastrtps::rtps::GUID_t& guid);
/// The part of it that all ends of one participant share.
std::string prefix_of(const eprosima::fastrtps::rtps::GUID_t& guid);

/// Keeps a Graph up to date with what other processes announce.
class DiscoveryListener : public eprosima::fastdds::dds::DomainParticipantListener {
 public:
  explicit DiscoveryListener(Graph& graph) : graph_(graph) {}

  void on_participant_discovery(eprosima::fastdds::dds::DomainParticipant*,
                                eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& info) override;
  void on_subscriber_discovery(eprosima::fastdds::dds::DomainParticipant*,
                               eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& info) override;
  void on_publisher_discovery(eprosima::fastdds::dds::DomainParticipant*,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) override;

 private:
  std::string participant_name(const eprosima::fastrtps::rtps::GUID_t& guid);

  Graph& graph_;
  std::mutex mutex_;
  std::map<std::string, std::string> names_;  // of participants, by GUID prefix
};

}  // namespace swiftlet
