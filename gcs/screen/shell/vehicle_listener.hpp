// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/topics.hpp"
#include "gcs/screen/state/ground_station_model.hpp"

namespace swiftlet::screen {

/// Hears what a vehicle says of itself, and keeps it in a model. Who looks at it calls the model's
/// tick.
class VehicleListener : public Component {
 public:
  explicit VehicleListener(const ComponentContext& context);
  const GroundStationModel& model() const { return model_; }

 protected:
  /// For who has more to do with it.
  virtual void heard(const swiftlet_msgs::msg::MissionState&) {}

  GroundStationModel model_;
};

}  // namespace swiftlet::screen
