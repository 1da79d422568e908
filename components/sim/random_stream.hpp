// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <string_view>

namespace swiftlet {

/// A source of random numbers that belongs to one user of them, such as one sensor.
///
/// It depends on the seed of the run and on the name of the user, and on nothing else: adding a
/// sensor does not change what the others see. The distributions are written out here because
/// those of the standard library may differ from one implementation to the next.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  /// Uniform in [0, 1).
  double uniform();
  /// Standard normal, by the polar method of Marsaglia.
  double normal();
  /// Three independent standard normal numbers.
  Eigen::Vector3d normal3();

 private:
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

/// One step of a first-order Gauss-Markov process with the stationary standard deviation `sigma`
/// and the time constant `tau` [s]: the exact discretisation over `dt` [s], driven by the standard
/// normal numbers `white`. `tau` zero gives white noise.
Eigen::Vector3d gauss_markov_step(const Eigen::Vector3d& state, const Eigen::Vector3d& sigma,
                                  double tau, double dt, const Eigen::Vector3d& white);

}  // namespace swiftlet
