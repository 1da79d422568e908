// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "components/report/flight_story.hpp"
#include "components/topics.hpp"

namespace swiftlet {

/// Reads how well battery and components were.
class HealthReader {
 public:
  HealthReader(FlightStory& story, double duration) : story_(story), duration_(duration) {}

  void on_battery(double time, const sensor_msgs::msg::BatteryState& message);
  void on_diagnostics(double time, const diagnostic_msgs::msg::DiagnosticArray& message);
  void on_component(double time, const swiftlet_msgs::msg::ComponentStatus& message);

 private:
  struct Said {
    std::uint8_t level = 0;
    std::string message;
  };
  void note_consistency(double time, const diagnostic_msgs::msg::DiagnosticStatus& status);

  FlightStory& story_;
  double duration_;
  std::optional<double> last_battery_;                     // time [s]
  std::map<std::string, Said> diagnostics_;                // by name
  std::map<std::string, std::set<std::string>> problems_;  // by component and process
  std::map<std::string, std::string> active_;              // instance that is, by component
};

}  // namespace swiftlet
