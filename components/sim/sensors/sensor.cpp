// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/sensors/sensor.hpp"

#include <cmath>

namespace swiftlet {

double quantised(double value, double resolution) {
  return resolution > 0.0 ? resolution * std::round(value / resolution) : value;
}

}  // namespace swiftlet
