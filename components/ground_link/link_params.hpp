// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "components/ground_link/link_budget.hpp"
#include "components/runtime/dds/network.hpp"
#include "components/runtime/qos.hpp"

namespace swiftlet {

/// A topic from the vehicle to the ground.
struct OutwardTopic {
  std::string name;
  double rate_hz = 0.0;     ///< 0: every message
  double resolution = 0.0;  ///< of a map, the finest that crosses [m]; 0: as it is
  bool essential = false;
};

struct GroundLinkParams {
  int domain = 0;  ///< of the link, another than the vehicle's
  NetworkConfig network;
  LinkBudget::Params budget;
  /// The first of them has the highest priority.
  std::vector<OutwardTopic> outward;
  std::vector<std::string> inward;
};

/// A command topic that can come from the ground.
struct InwardTopic {
  std::string name;
  std::string type;  ///< as on the wire
  QosProfile qos;
};
const std::vector<InwardTopic>& inward_topics();

/// Throws ConfigError. `vehicle_domain` is the one inside the vehicle.
GroundLinkParams read_ground_link(const Config& config, int vehicle_domain);

}  // namespace swiftlet
