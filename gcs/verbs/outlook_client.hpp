// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gcs/screen/shell/vehicle_listener.hpp"
#include "gcs/screen/state/circumstances.hpp"

namespace swiftlet {

/// Listens for what a mission is checked by, as the screen does: where the vehicle is, what its
/// flights are held to, its battery, the map, and for missions with places on Earth where that is.
/// Ends the run when all of that is known, at last two seconds after the vehicle was heard first,
/// or where it was not heard for `patience`.
class OutlookClient : public screen::VehicleListener {
 public:
  static constexpr Duration kMoment = std::chrono::seconds(2);  ///< for all that is not there yet
  static constexpr Duration kMapMoment = std::chrono::milliseconds(500);  ///< for the map alone

  OutlookClient(const ComponentContext& context, Duration patience, bool on_earth);

  /// Whether anything was heard of the vehicle.
  bool is_heard() const { return heard_.has_value(); }
  /// As it was at the end; nothing where the run was interrupted.
  const std::optional<screen::Circumstances>& circumstances() const { return circumstances_; }

 private:
  void advance(Time now);
  bool knows_all_but_map(Time now) const;

  bool on_earth_;
  Time deadline_;               // for the vehicle to be heard
  std::optional<Time> heard_;   // the vehicle, first
  std::optional<Time> nearly_;  // all but the map was known
  std::optional<screen::Circumstances> circumstances_;
};

}  // namespace swiftlet
