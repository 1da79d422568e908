// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

namespace swiftlet {

/// N coefficients of a polynomial on [0, 1], in the power basis where nothing else is said.
template <int N>
using Coefficients = Eigen::Matrix<double, N, 1>;

/// Coefficients of the `order`-th derivative.
template <int N>
Coefficients<N> differentiate(Coefficients<N> c, int order = 1) {
  for (int k = 0; k < order; ++k) {
    for (int i = 0; i + 1 < N; ++i) c[i] = (i + 1) * c[i + 1];
    c[N - 1] = 0.0;
  }
  return c;
}

/// Value at s.
template <int N>
double horner(const Coefficients<N>& c, double s) {
  double value = 0.0;
  for (int i = N - 1; i >= 0; --i) value = value * s + c[i];
  return value;
}

/// Adds the square of a polynomial to `sum`.
template <int N>
void add_square(const Coefficients<N>& c, Coefficients<2 * N - 1>& sum) {
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) sum[i + j] += c[i] * c[j];
  }
}

/// Power basis to Bernstein basis, b_j = sum_i C(j, i) / C(n, i) a_i, for every column of `power`.
template <class Matrix>
Matrix to_bernstein(const Matrix& power) {
  constexpr int n = Matrix::RowsAtCompileTime - 1;
  Matrix b;
  for (int j = 0; j <= n; ++j) {
    double ratio = 1.0;  // C(j, i) / C(n, i)
    b.row(j).setZero();
    for (int i = 0; i <= j; ++i) {
      b.row(j) += ratio * power.row(i);
      ratio *= static_cast<double>(j - i) / (n - i);
    }
  }
  return b;
}

/// De Casteljau's subdivision in the middle, for every column of Bernstein coefficients.
template <class Matrix>
std::pair<Matrix, Matrix> bernstein_halves(const Matrix& bernstein) {
  constexpr int N = Matrix::RowsAtCompileTime;
  std::pair<Matrix, Matrix> halves(bernstein, bernstein);
  auto& [left, right] = halves;
  for (int k = 0; k < N; ++k) {
    left.row(k) = right.row(0);
    for (int i = 0; i + 1 < N - k; ++i) right.row(i) = 0.5 * (right.row(i) + right.row(i + 1));
  }
  return halves;
}

/// Relative width at which a search for a maximum ends, and its bound on work.
inline constexpr double kMaximumTolerance = 1e-6;
inline constexpr int kMaxSubdivisions = 2000;
/// After so many, what has no bound yet has none.
inline constexpr int kHopefulSubdivisions = 100;

/// Upper bound of a function on an interval by branch and bound, at most kMaximumTolerance above a
/// value that is taken unless kMaxSubdivisions do not suffice. A Piece knows two numbers about a
/// part of the interval, `above`, which no value exceeds, and `taken`, a value that is taken, and
/// has `halves()`. The search ends early with a bound that is no more than `good_enough`.
template <class Piece>
double least_upper_bound(const Piece& whole,
                         double good_enough = -std::numeric_limits<double>::infinity()) {
  const auto less = [](const Piece& a, const Piece& b) { return a.above < b.above; };
  std::priority_queue<Piece, std::vector<Piece>, decltype(less)> pieces(less);
  pieces.push(whole);
  double taken = whole.taken;
  for (int k = 0; k < kMaxSubdivisions; ++k) {
    const Piece top = pieces.top();
    if (top.above <= taken + kMaximumTolerance * std::abs(taken) + 1e-18) break;
    if (top.above <= good_enough) break;
    if (k >= kHopefulSubdivisions && !std::isfinite(top.above)) break;
    pieces.pop();
    const auto [left, right] = top.halves();
    taken = std::max({taken, left.taken, right.taken});
    pieces.push(left);
    pieces.push(right);
  }
  return std::max(taken, pieces.top().above);
}

/// A polynomial on a part of the interval, in its Bernstein form: the largest coefficient is above
/// every value, the first and the last are taken.
template <int N>
struct BernsteinPiece {
  explicit BernsteinPiece(const Coefficients<N>& bernstein)
      : b(bernstein), above(b.maxCoeff()), taken(std::max(b[0], b[N - 1])) {}
  std::pair<BernsteinPiece, BernsteinPiece> halves() const {
    const auto [left, right] = bernstein_halves(b);
    return {BernsteinPiece(left), BernsteinPiece(right)};
  }

  Coefficients<N> b;
  double above, taken;
};

/// No value of the polynomial on [0, 1] is above this, and one is at most kMaximumTolerance
/// (relative) below. True but for rounding of the coefficients.
template <int N>
double upper_bound(const Coefficients<N>& power) {
  return least_upper_bound(BernsteinPiece<N>(to_bernstein(power)));
}

/// The same from below.
template <int N>
double lower_bound(const Coefficients<N>& power) {
  return -upper_bound<N>(-power);
}

}  // namespace swiftlet
