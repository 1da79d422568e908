// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/battery/discharge_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet {

void DischargeEstimate::begin(Time time, double charge) {
  n_ = n2_ = u_ = uu_ = c_ = uc_ = cc_ = 0.0;
  begun_ = true;
  first_ = last_ = time;
  fullest_ = charge;
}

void DischargeEstimate::add(Time time, double charge) {
  if (!std::isfinite(charge)) return;
  const double elapsed = to_seconds(time - last_);
  const bool goes_on = begun_ && elapsed <= params_.longest_gap &&
                       std::abs(charge - last_charge_) <= params_.largest_step;
  if (begun_ && elapsed <= 0.0) return;
  if (!goes_on) begin(time, charge);
  const double dt = goes_on ? elapsed : 0.0;
  const double kept = std::exp(-dt / params_.time_constant);
  // All samples move into the past by dt, and lose weight.
  uu_ = kept * (uu_ - 2.0 * dt * u_ + dt * dt * n_);
  uc_ = kept * (uc_ - dt * c_);
  u_ = kept * (u_ - dt * n_);
  n_ = kept * n_ + 1.0;
  n2_ = kept * kept * n2_ + 1.0;
  c_ = kept * c_ + charge;
  cc_ = kept * cc_ + charge * charge;
  last_ = time;
  last_charge_ = charge;
  fullest_ = std::max(fullest_, charge);
}

DischargeEstimate::Line DischargeEstimate::fit() const {
  const double mean_u = u_ / n_;
  const double mean_c = c_ / n_;
  const double var_u = std::max(uu_ / n_ - mean_u * mean_u, 1e-12);
  const double covariance = uc_ / n_ - mean_u * mean_c;
  const double rate = covariance / var_u;
  const double residual = std::max(cc_ / n_ - mean_c * mean_c - rate * covariance, 0.0);
  const double effective = n_ * n_ / n2_;  // number of samples that count
  return {mean_c - rate * mean_u, rate, residual / (effective * var_u)};
}

std::optional<double> DischargeEstimate::time_left(Time now) const {
  if (!begun_ || to_seconds(last_ - first_) < params_.least_time) return std::nullopt;
  const double age = to_seconds(now - last_);
  if (age < 0.0 || age > params_.longest_gap) return std::nullopt;
  const Line line = fit();
  if (fullest_ - line.charge < params_.least_discharge) return std::nullopt;
  if (-line.rate <= params_.significance * std::sqrt(line.variance)) return std::nullopt;
  const double left = line.charge / -line.rate - age;
  if (left > params_.longest_time) return std::nullopt;
  return std::max(left, 0.0);
}

}  // namespace swiftlet
