// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "components/runtime/graph.hpp"
#include "estimation/basics/result.hpp"

namespace swiftlet {

/// The graph as seen from outside: without the ends of the one who looks.
struct GraphView {
  std::vector<Endpoint> endpoints;  ///< by component, process and topic
  std::vector<Conflict> conflicts;
};

/// Without what `component` of process `process` and the announcer beside it have in the graph.
/// User data of other vendors' endpoints is no component's name.
GraphView view_of(const Graph& graph, const std::string& component, const std::string& process);

/// Everything that is known of one topic.
struct TopicView {
  std::string wire;                ///< "rt/uav1/imu0"
  std::string name;                ///< "imu0" for somebody who looks at uav1, else "uav1/imu0"
  std::vector<std::string> types;  ///< "sensor_msgs/msg/Imu"; several only where ends disagree
  std::vector<Endpoint> writers;
  std::vector<Endpoint> readers;
  std::vector<Conflict> conflicts;
};

/// By name. With a vehicle, the topics of that vehicle only.
std::vector<TopicView> topics_of(const GraphView& view, const std::string& vehicle);

/// The topic that a person means by "odometry" or "/odometry": that of the vehicle first, then one
/// of the whole name, then one as it is on the wire. Else why there is none, naming the nearest.
Result<TopicView> find_topic(const GraphView& view, const std::string& vehicle,
                             const std::string& name);

/// What ROS 2 has for services and its graph, and the signs of life of our components.
bool is_hidden(const std::string& wire_topic);

/// "planner of process planner.1234", "process rviz2" for what is not ours.
std::string who(const Endpoint& endpoint);
/// The same of several, with commas.
std::string who(const std::vector<Endpoint>& endpoints);

/// "reliable, transient local".
std::string qos_text(const QosProfile& qos);

}  // namespace swiftlet
