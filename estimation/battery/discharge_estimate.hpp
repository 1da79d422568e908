// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "estimation/basics/time.hpp"

namespace swiftlet {

/// How long a battery lasts at the rate at which it was emptied of late: a line through its charge,
/// by least squares in which older samples count exponentially less. It says nothing until the
/// slope stands out of the noise, and nothing while the battery is charged or rests.
class DischargeEstimate {
 public:
  struct Params {
    double time_constant = 60.0;     ///< after which a sample counts 1/e [s]
    double least_time = 30.0;        ///< that it has to be seen [s]
    double least_discharge = 0.02;   ///< since it was fullest, of the capacity [0..1]
    double significance = 5.0;       ///< of the slope, in its standard deviations
    double longest_gap = 10.0;       ///< after a longer one all begins anew [s]
    double largest_step = 0.1;       ///< a larger one is another battery, of the capacity [0..1]
    double longest_time = 86'400.0;  ///< what lasts longer is not being emptied [s]
  };

  DischargeEstimate() : DischargeEstimate(Params()) {}
  explicit DischargeEstimate(const Params& params) : params_(params) {}

  /// `charge` of the capacity [0..1]. What is not finite, or not newer, is left out.
  void add(Time time, double charge);
  /// Until it is empty [s]; nothing where that is not known.
  std::optional<double> time_left(Time now) const;

 private:
  struct Line {
    double charge;    // now
    double rate;      // [1/s]
    double variance;  // of the rate
  };
  Line fit() const;
  void begin(Time time, double charge);

  Params params_;
  bool begun_ = false;
  Time first_{};
  Time last_{};
  double last_charge_ = 0.0;
  double fullest_ = 0.0;
  // Weighted sums over samples, u being their time relative to the last one: of 1, of squared
  // weights, of u, u^2, charge, u charge and charge^2.
  double n_ = 0.0, n2_ = 0.0, u_ = 0.0, uu_ = 0.0, c_ = 0.0, uc_ = 0.0, cc_ = 0.0;
};

}  // namespace swiftlet
