// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>

#include "estimation/basics/time.hpp"

namespace swiftlet {

struct Spread {
  double mean = 0.0;
  double min = 0.0;
  double max = 0.0;
  double deviation = 0.0;  ///< standard deviation of the values themselves
  std::size_t count = 0;
};

/// The last values of something that is measured again and again.
class SlidingWindow {
 public:
  explicit SlidingWindow(std::size_t longest) : longest_(longest) {}

  void add(Time time, double value);
  bool empty() const { return values_.empty(); }
  /// Only where it is not empty.
  Spread spread() const;
  double oldest() const { return values_.front().value; }
  /// From the oldest value to `now`.
  Duration age(Time now) const { return now - values_.front().time; }

 private:
  struct Entry {
    Time time;
    double value;
  };
  std::size_t longest_;
  std::deque<Entry> values_;
};

}  // namespace swiftlet
