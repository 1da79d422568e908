// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>

#include "estimation/basics/time.hpp"

namespace swiftlet::screen {

/// What is not heard for longer is not true any more.
inline constexpr Duration kStale = std::chrono::seconds(1);

/// A value that somebody sends again and again, and when it came last.
template <class T>
class Heard {
 public:
  explicit Heard(Duration stale_after = kStale) : stale_after_(stale_after) {}

  void hear(T value, Time now) {
    value_ = std::move(value);
    at_ = now;
  }
  bool known() const { return value_.has_value(); }
  const T* operator->() const { return &*value_; }
  const T& operator*() const { return *value_; }
  /// Only where it is known.
  Duration age(Time now) const { return now - at_; }
  bool fresh(Time now) const { return known() && age(now) <= stale_after_; }

 private:
  std::optional<T> value_;
  Time at_{};
  Duration stale_after_;
};

/// Who is heard first-hand needs nobody to speak for him. Others do before he is stale, so that
/// nothing is while they know it.
class FirstHand {
 public:
  explicit FirstHand(Duration silent_after = std::chrono::milliseconds(600))
      : silent_after_(silent_after) {}

  void hear(Time now) { at_ = now; }
  bool silent(Time now) const { return !at_ || now - *at_ > silent_after_; }

 private:
  std::optional<Time> at_;
  Duration silent_after_;
};

}  // namespace swiftlet::screen
