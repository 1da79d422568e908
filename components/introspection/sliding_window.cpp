// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/sliding_window.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet {

void SlidingWindow::add(Time time, double value) {
  values_.push_back({time, value});
  if (values_.size() > longest_) values_.pop_front();
}

Spread SlidingWindow::spread() const {
  Spread spread;
  spread.count = values_.size();
  spread.min = spread.max = values_.front().value;
  double sum = 0.0;
  for (const Entry& entry : values_) {
    spread.min = std::min(spread.min, entry.value);
    spread.max = std::max(spread.max, entry.value);
    sum += entry.value;
  }
  const auto count = static_cast<double>(spread.count);
  spread.mean = sum / count;
  double squares = 0.0;
  for (const Entry& entry : values_) squares += std::pow(entry.value - spread.mean, 2);
  spread.deviation = std::sqrt(squares / count);
  return spread;
}

}  // namespace swiftlet
