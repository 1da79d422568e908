// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "components/introspection/graph_view.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

/// One running instance of a component, as it shows itself.
struct Instance {
  std::string vehicle;
  std::string component;
  std::string process;
  bool has_status = false;  ///< it says of itself what follows
  bool active = false;
  int standby = 0;  ///< place in the line of succession
  std::uint32_t term = 0;
  Duration period{};  ///< between two signs of life
  Time heard{};       ///< the last one
  std::vector<std::string> problems;

  /// "uav1/planner", "planner" for somebody who looks at uav1.
  std::string name(const std::string& seen_from) const;
  /// "active", "standby 1", "silent", "-" for one that does not say.
  std::string state(Time now) const;
  /// Whether it said that it lives, and does no more.
  bool silent(Time now) const;
};

/// Instances by what they say of themselves.
class InstanceBook {
 public:
  /// A ComponentStatus that came on a topic; topics of the vehicle's name are told by `wire_topic`.
  /// Signs of life (alive/...) say nothing of problems.
  void note(const std::string& wire_topic, const std::vector<std::uint8_t>& cdr, Time now);

  /// Also those that the graph has and that never said a word. By name, then the active one first.
  std::vector<Instance> all(const GraphView& view, const std::string& vehicle) const;

 private:
  struct Key {
    std::string vehicle, component, process;
    bool operator<(const Key& other) const;
  };
  std::map<Key, Instance> said_;
};

/// The vehicle of a topic on which components show themselves: "uav1" of
/// "rt/uav1/component/status". Nothing for any other topic.
bool is_status_topic(const std::string& wire_topic, std::string* vehicle = nullptr);

/// A table with a line for each instance.
std::string instances_text(const std::vector<Instance>& instances, const std::string& vehicle,
                           Time now);
nlohmann::ordered_json instances_json(const std::vector<Instance>& instances, Time now);

/// Instances, inputs and outputs of one component, as `view` has them.
std::string instance_text(const Instance& instance, const GraphView& view,
                          const std::string& vehicle, Time now);
nlohmann::ordered_json instance_json(const Instance& instance, const GraphView& view,
                                     const std::string& vehicle, Time now);

}  // namespace swiftlet
