// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/random_stream.hpp"

#include <cmath>

namespace swiftlet {

namespace {

/// FNV-1a; std::hash may differ between implementations.
std::uint64_t hash(std::string_view text) {
  std::uint64_t h = 14695981039346656037ULL;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return h;
}

/// SplitMix64: neighbouring seeds become unrelated ones.
std::uint64_t mix(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name)
    : engine_(mix(mix(seed) ^ hash(name))) {}

double RandomStream::uniform() {
  return static_cast<double>(engine_() >> 11) * 0x1.0p-53;
}

double RandomStream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  double u = 0.0;
  double v = 0.0;
  double s = 0.0;
  do {
    u = 2.0 * uniform() - 1.0;
    v = 2.0 * uniform() - 1.0;
    s = u * u + v * v;
  } while (s >= 1.0 || s == 0.0);
  const double k = std::sqrt(-2.0 * std::log(s) / s);
  spare_ = v * k;
  has_spare_ = true;
  return u * k;
}

Eigen::Vector3d RandomStream::normal3() {
  // One after the other: the order in which the arguments of a call are computed is not fixed.
  Eigen::Vector3d n;
  n.x() = normal();
  n.y() = normal();
  n.z() = normal();
  return n;
}

Eigen::Vector3d gauss_markov_step(const Eigen::Vector3d& state, const Eigen::Vector3d& sigma,
                                  double tau, double dt, const Eigen::Vector3d& white) {
  const double decay = tau > 0.0 ? std::exp(-dt / tau) : 0.0;
  return decay * state + std::sqrt(1.0 - decay * decay) * sigma.cwiseProduct(white);
}

}  // namespace swiftlet
