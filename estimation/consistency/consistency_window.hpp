// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace swiftlet {

/// Quantile of the chi-square distribution by Wilson and Hilferty: within 3 % at 6 degrees of
/// freedom, within 0.03 % at 100. `normal_quantile` is that of the standard normal: 1.96 for 97.5
/// %.
double chi_square_quantile(double degrees, double normal_quantile);

/// Whether a filter's covariance is as large as its errors: the mean of normalised squares (NIS of
/// innovations, NEES of errors against the truth), each chi-square distributed with `degrees`
/// degrees of freedom where it is (Bar-Shalom, Li and Kirubarajan 2001, section 5.4).
class ConsistencyWindow {
 public:
  explicit ConsistencyWindow(int degrees) : degrees_(degrees) {}

  void add(double normalised_square) {
    sum_ += normalised_square;
    ++count_;
  }
  void clear() { *this = ConsistencyWindow(degrees_); }

  std::int64_t count() const { return count_; }
  /// Mean of what was added; zero where that is nothing.
  double mean() const { return count_ == 0 ? 0.0 : sum_ / static_cast<double>(count_); }
  /// Ends of the two-sided 95 % band of the mean, for independent values.
  double low() const { return bound(-1.96); }
  double high() const { return bound(1.96); }

 private:
  double bound(double normal_quantile) const;

  int degrees_;
  double sum_ = 0.0;
  std::int64_t count_ = 0;
};

}  // namespace swiftlet
