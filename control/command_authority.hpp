// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "estimation/basics/result.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

/// Which ground station may command the vehicle: one at a time. The first that commands has
/// control, until it hands it over, lets it go, or has not been heard for `lease`: a station whose
/// link is gone must not lock everybody out. Stations are known by their names.
class CommandAuthority {
 public:
  struct State {
    std::string holder;  ///< "" where no station has control
    Time heard{};        ///< when the holder was heard last
    std::string giver;   ///< of whom the holder has it, until the holder is heard
  };

  explicit CommandAuthority(Duration lease) : lease_(lease) {}
  void set_lease(Duration lease) { lease_ = lease; }

  /// Whether a command of this station is to be carried out; where nobody has control, it has from
  /// now on. An error says who has, and what to do.
  Status claim(const std::string& station, Time now);
  /// As `claim`; and who gave control to a station that was not heard since may have it back.
  Status take(const std::string& station, Time now);
  /// A sign of life of a station.
  void hear(const std::string& station, Time now);
  /// The next holder is `successor`, for the lease at least; only the holder may say so. A name
  /// that nobody has is not found out here: `take` undoes it.
  Status give(const std::string& station, const std::string& successor, Time now);
  /// Nobody has control, and the next that commands gets it; only the holder may say so.
  Status release(const std::string& station, Time now);

  /// Who has control; "" where nobody has.
  const std::string& holder(Time now) const;

  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

 private:
  Duration lease_;
  State state_;
};

}  // namespace swiftlet
