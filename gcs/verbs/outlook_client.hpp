// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gcs/screen/shell/vehicle_listener.hpp"
#include "gcs/screen/state/circumstances.hpp"

namespace swiftlet {

/// Listens for what a mission is checked against: where the vehicle is, what its flights are held
/// to, its battery, and the map. Ends the run when all of that is known, or after `patience`.
class OutlookClient : public screen::VehicleListener {
 public:
  static constexpr Duration kPatience = std::chrono::seconds(2);

  explicit OutlookClient(const ComponentContext& context, Duration patience = kPatience);

  /// As of the end of the run.
  screen::Circumstances circumstances() const;
  /// What is not known, and not checked therefore: "the fence", "obstacles".
  std::vector<std::string> unknown() const;

 private:
  bool is_complete() const;
};

}  // namespace swiftlet
