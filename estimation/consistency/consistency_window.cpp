// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/consistency/consistency_window.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet {

double chi_square_quantile(double degrees, double normal_quantile) {
  const double k = 2.0 / (9.0 * degrees);
  return degrees * std::pow(std::max(0.0, 1.0 - k + normal_quantile * std::sqrt(k)), 3);
}

double ConsistencyWindow::bound(double normal_quantile) const {
  const auto count = static_cast<double>(std::max<std::int64_t>(1, count_));
  return chi_square_quantile(degrees_ * count, normal_quantile) / count;
}

}  // namespace swiftlet
