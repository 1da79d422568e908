// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "components/introspection/graph_view.hpp"

namespace swiftlet {

struct TopicListOptions {
  bool types = false;   ///< "scan [sensor_msgs/msg/LaserScan]"
  bool counts = false;  ///< of writers and readers, and whether they fit together
  bool all = false;     ///< hidden topics, too
};

std::string list_text(const std::vector<TopicView>& topics, const TopicListOptions& options);
nlohmann::ordered_json list_json(const std::vector<TopicView>& topics, bool all);

/// Type, ends, quality of service, conflicts; with `verbose` also the identity of each end.
std::string info_text(const TopicView& topic, bool verbose);
nlohmann::ordered_json info_json(const TopicView& topic);

}  // namespace swiftlet
