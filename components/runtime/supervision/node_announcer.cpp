// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/supervision/node_announcer.hpp"

#include <algorithm>
#include <cctype>
#include <map>

namespace swiftlet {

using namespace rmw_dds_common::msg;

namespace {

using namespace std::chrono_literals;

/// Without the prefix that topics of ROS 2 have on the wire.
constexpr const char* kTopic = "ros_discovery_info";
constexpr Duration kPeriod = 250ms;
/// Of an entity that is no user's endpoint: the participant itself.
constexpr const char* kParticipantEntity = "|0.0.1.c1";

/// From "01.0f.a2...|0.0.1.3", as Fast DDS writes GUIDs.
Gid gid_of(const std::string& guid) {
  Gid gid;
  std::size_t byte = 0;
  for (std::size_t at = 0; at < guid.size() && byte < 16; ++byte) {
    const std::size_t end = std::min(guid.find_first_of(".|", at), guid.size());
    gid.data()[byte] =
        static_cast<std::uint8_t>(std::stoul(guid.substr(at, end - at), nullptr, 16));
    at = end + 1;
  }
  return gid;
}

}  // namespace

ParticipantEntitiesInfo nodes_of(const std::string& participant_id, const std::string& vehicle,
                                 const std::vector<Endpoint>& endpoints) {
  std::map<std::string, NodeEntitiesInfo> nodes;
  for (const Endpoint& endpoint : endpoints) {
    if (endpoint.id.compare(0, participant_id.size(), participant_id) != 0) continue;
    NodeEntitiesInfo& node = nodes[endpoint.component];
    node.node_namespace("/" + vehicle);
    node.node_name(endpoint.component);
    auto& gids = endpoint.is_writer ? node.writer_gid_seq() : node.reader_gid_seq();
    gids.push_back(gid_of(endpoint.id));
  }
  ParticipantEntitiesInfo info;
  info.gid(gid_of(participant_id + kParticipantEntity));
  for (auto& [name, node] : nodes) info.node_entities_info_seq().push_back(std::move(node));
  return info;
}

NodeAnnouncer::NodeAnnouncer(const ComponentContext& context) : Component(context) {
  // As rmw_dds_common asks for it: reliable, transient local, keep last 1.
  const MessageType& type = message_type<ParticipantEntitiesInfo>();
  writer_ = advertise_raw(kTopic, type.dds_name(), qos::map);
  every(kPeriod, [this](Time) { announce(); });
}

void NodeAnnouncer::announce() {
  Cdr info = to_cdr(nodes_of(context().participant->id(), context().vehicle,
                             context().participant->graph().endpoints()));
  if (info == announced_) return;
  writer_->write(info);
  announced_ = std::move(info);
}

}  // namespace swiftlet
