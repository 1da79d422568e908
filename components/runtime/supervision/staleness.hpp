// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/basics/time.hpp"

namespace swiftlet {

/// Whether something that should come every `period` still comes, on the clock of the component
/// that waits for it: DDS deadlines and liveliness run on wall time, and fire late in Fast DDS 2.9.
class StalenessWatch {
 public:
  explicit StalenessWatch(Duration period, int periods = 3) : limit_(period * periods) {}

  void heard(Time now) {
    last_ = now;
    ever_ = true;
  }
  /// Also true as long as nothing was heard at all.
  bool stale(Time now) const { return !ever_ || now - last_ > limit_; }
  bool ever_heard() const { return ever_; }

 private:
  Duration limit_;
  Time last_{};
  bool ever_ = false;
};

}  // namespace swiftlet
