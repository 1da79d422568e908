// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "components/sim/random_stream.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

/// Wind: a mean and gusts. Each axis of the gusts is a first-order Gauss-Markov process, which has
/// the spectrum of Dryden's longitudinal gusts at a fixed airspeed.
class Wind {
 public:
  struct Params {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();            ///< velocity of the air, ENU [m/s]
    Eigen::Vector3d gust_intensity = Eigen::Vector3d::Zero();  ///< standard deviation [m/s]
    double gust_time_constant = 2.0;                           ///< [s]
  };

  Wind(const Params& params, RandomStream random);

  /// Moves on by `dt`.
  void step(Duration dt);
  /// Velocity of the air in the world, ENU [m/s].
  Eigen::Vector3d velocity() const { return params_.mean + gust_; }

 private:
  Params params_;
  RandomStream random_;
  Eigen::Vector3d gust_;
};

}  // namespace swiftlet
