// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Graphs made by hand.
#pragma once

#include <string>
#include <vector>

#include "components/introspection/graph_view.hpp"

namespace swiftlet::test {

inline constexpr const char* kImuType = "sensor_msgs::msg::dds_::Imu_";
inline constexpr const char* kScanType = "sensor_msgs::msg::dds_::LaserScan_";

/// An end of `component` in a process of the same name.
inline Endpoint end(bool is_writer, const std::string& topic, const std::string& component,
                    const std::string& type = kImuType, const QosProfile& qos = qos::state) {
  const std::string process = component.empty() ? "rviz2" : component + ".1";
  const std::string id = process + "|" + topic + (is_writer ? "w" : "r");
  return {id, topic, type, is_writer, qos, component, process};
}
inline Endpoint writer(const std::string& topic, const std::string& component,
                       const std::string& type = kImuType, const QosProfile& qos = qos::state) {
  return end(true, topic, component, type, qos);
}
inline Endpoint reader(const std::string& topic, const std::string& component,
                       const std::string& type = kImuType, const QosProfile& qos = qos::state) {
  return end(false, topic, component, type, qos);
}

/// What somebody sees who has no ends of its own.
inline GraphView view_of_all(const std::vector<Endpoint>& ends) {
  Graph graph([](const Conflict&) {});
  for (const Endpoint& endpoint : ends) graph.add(endpoint);
  return view_of(graph, "observer", "observer.1");
}

}  // namespace swiftlet::test
