// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/ground_link/link_params.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "components/runtime/names.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

constexpr int kLastDomain = 232;
/// Below the MTU of any radio link that carries IP: what is lost is then one datagram.
constexpr int kMaxDatagram = 1400;

template <class T>
InwardTopic inward_topic(const Topic<T>& topic) {
  return {topic.name, message_type<T>().dds_name(), topic.qos};
}

/// What a ground station needs, in order of priority.
std::vector<OutwardTopic> standard_outward() {
  return {
      {topic::vehicle_status.name, 5.0, 0.0, true},  {topic::mode_ack.name, 0.0, 0.0, true},
      {topic::mission_state.name, 2.0, 0.0, true},   {topic::mission_download.name, 0.0, 0.0, true},
      {topic::parameter_reply.name, 0.0, 0.0, true}, {topic::component_status.name, 0.0, 0.0, true},
      {topic::diagnostics.name, 0.0, 0.0, true},     {topic::guard_status.name, 2.0, 0.0, true},
      {topic::vehicle_limits.name, 0.5, 0.0, true},  {topic::battery.name, 1.0, 0.0, false},
      {topic::odometry.name, 5.0, 0.0, false},       {topic::gps_fix.name, 1.0, 0.0, false},
      {topic::claw_state.name, 2.0, 0.0, false},     {topic::telemetry.name, 1.0, 0.0, false},
      {topic::path.name, 1.0, 0.0, false},           {topic::map.name, 0.2, 0.1, false}};
}

OutwardTopic read_outward(const Config& section) {
  OutwardTopic topic;
  section.require("topic", topic.name);
  const Status status = check_name(topic.name);
  if (!status.ok()) section.fail("topic", status.error().reason);
  section.read("rate", topic.rate_hz, {0.0, 1000.0});
  section.read("resolution", topic.resolution, {0.0, 100.0});
  section.read("essential", topic.essential);
  return topic;
}

void check_inward(const Config& config, const std::string& name) {
  std::vector<std::string> known;
  for (const InwardTopic& topic : inward_topics()) known.push_back(topic.name);
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  const std::string near = nearest_word(name, known);
  config.fail("inward",
              fmt::format("'{}' is no command that can come from the ground; {}", name,
                          near.empty() ? fmt::format("there are {}", fmt::join(known, ", "))
                                       : fmt::format("did you mean '{}'?", near)));
}

}  // namespace

const std::vector<InwardTopic>& inward_topics() {
  static const std::vector<InwardTopic> topics{inward_topic(topic::mode),
                                               inward_topic(topic::waypoints),
                                               inward_topic(topic::mission_upload),
                                               inward_topic(topic::mission_fetch),
                                               inward_topic(topic::goal_pose),
                                               inward_topic(topic::goal),
                                               inward_topic(topic::parameter_request),
                                               inward_topic(topic::manual_control),
                                               inward_topic(topic::gcs_heartbeat)};
  return topics;
}

GroundLinkParams read_ground_link(const Config& config, int vehicle_domain) {
  GroundLinkParams params;
  config.require("domain", params.domain, Range{0, kLastDomain});
  if (params.domain == vehicle_domain) {
    config.fail("domain", fmt::format("'domain' is {}, which is the vehicle's own; the link needs "
                                      "another, so that only what is listed crosses it",
                                      params.domain));
  }
  params.network = read_network(config.child("network"));
  config.read("budget", params.budget.bytes_per_s, {100.0, 1e9});
  config.read("burst", params.budget.burst, {0.02, 10.0});
  if (params.network.max_datagram == 0) params.network.max_datagram = kMaxDatagram;
  if (params.network.pace == 0) params.network.pace = static_cast<int>(params.budget.bytes_per_s);

  params.outward = standard_outward();
  if (config.has("outward")) {
    params.outward.clear();
    for (const Config& section : config.list("outward")) {
      params.outward.push_back(read_outward(section));
    }
  }
  params.inward = {topic::mode.name,           topic::waypoints.name,
                   topic::mission_upload.name, topic::mission_fetch.name,
                   topic::goal_pose.name,      topic::parameter_request.name,
                   topic::manual_control.name, topic::gcs_heartbeat.name};
  config.read("inward", params.inward);
  std::set<std::string> names;
  for (const std::string& name : params.inward) {
    check_inward(config, name);
    if (!names.insert(name).second) {
      config.fail("inward", fmt::format("'{}' is listed twice; keep one", name));
    }
  }
  for (const OutwardTopic& topic : params.outward) {
    if (!names.insert(topic.name).second) {
      config.fail("outward",
                  fmt::format("'{}' is listed twice, or outward and inward; a topic crosses the "
                              "link once",
                              topic.name));
    }
  }
  return params;
}

}  // namespace swiftlet
