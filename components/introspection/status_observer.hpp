// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "components/introspection/instances.hpp"
#include "components/introspection/observer.hpp"

namespace swiftlet {

/// Listens for a while to what components say of themselves: those of the vehicle that was asked
/// for, else of all.
class StatusObserver : public Observer {
 public:
  /// `listen` counts from when the graph is at rest.
  StatusObserver(const ComponentContext& context, Duration listen);

  /// When it has stopped: the graph and the instances at its end.
  const GraphView& last_view() const { return last_view_; }
  const std::vector<Instance>& instances() const { return instances_; }
  Time end() const { return end_; }

 private:
  void begin(const GraphView& view) override;
  void look_for_topics();

  Duration listen_;
  std::set<std::string> heard_topics_;
  InstanceBook book_;
  GraphView last_view_;
  std::vector<Instance> instances_;
  Time end_{};
};

/// Long enough for the problems of every component, which come five times a second.
inline constexpr Duration kListen = std::chrono::milliseconds(350);

}  // namespace swiftlet
