// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "components/runtime/component.hpp"
#include "rmw_dds_common.h"

namespace swiftlet {

/// What `ros_discovery_info` says of one participant: a node for each of its components, with the
/// readers and writers among `endpoints` that are this participant's.
rmw_dds_common::msg::ParticipantEntitiesInfo nodes_of(const std::string& participant_id,
                                                      const std::string& vehicle,
                                                      const std::vector<Endpoint>& endpoints);

/// Announces the components of this process as ROS 2 Humble announces nodes, so that
/// `ros2 node list` shows them; again whenever their readers and writers change.
class NodeAnnouncer : public Component {
 public:
  explicit NodeAnnouncer(const ComponentContext& context);

 private:
  void announce();

  std::shared_ptr<Writer> writer_;
  Cdr announced_;
};

}  // namespace swiftlet
