// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/exploration/visiting_order.hpp"

#include <algorithm>
#include <limits>

namespace swiftlet {
namespace {

using Order = std::vector<std::size_t>;
using Lengths = std::vector<std::vector<double>>;

/// Less is not worth a change [m]: rounding must not make a circle of changes.
constexpr double kWorthwhile = 1e-6;

Order insert_cheapest(const Lengths& between) {
  const std::size_t last = between.size() - 1;
  Order order{0, last};
  std::vector<bool> placed(between.size(), false);
  for (std::size_t count = 2; count < between.size(); ++count) {
    double least = std::numeric_limits<double>::infinity();
    std::size_t best = 0, at = 1;
    for (std::size_t node = 1; node < last; ++node) {
      if (placed[node]) continue;
      for (std::size_t i = 1; i < order.size(); ++i) {
        const std::size_t a = order[i - 1], b = order[i];
        const double more = between[a][node] + between[node][b] - between[a][b];
        if (best == 0 || more < least) {
          least = more;
          best = node;
          at = i;
        }
      }
    }
    placed[best] = true;
    order.insert(order.begin() + static_cast<std::ptrdiff_t>(at), best);
  }
  return order;
}

/// Takes order[i..j] out and puts it, or its reverse, elsewhere or at its place.
bool improve(Order& order, const Lengths& between) {
  const double length = length_of(order, between);
  Order best;
  double least = length - kWorthwhile;
  for (std::size_t i = 1; i + 1 < order.size(); ++i) {
    for (std::size_t j = i; j + 1 < order.size(); ++j) {
      const auto first = order.begin() + static_cast<std::ptrdiff_t>(i);
      const auto end = order.begin() + static_cast<std::ptrdiff_t>(j) + 1;
      Order rest(order.begin(), first);
      rest.insert(rest.end(), end, order.end());
      for (const bool reverse : {false, true}) {
        Order piece(first, end);
        if (reverse) std::reverse(piece.begin(), piece.end());
        const double own = length_of(piece, between);
        const double without = length_of(rest, between) + own;
        for (std::size_t k = 1; k < rest.size(); ++k) {
          const std::size_t a = rest[k - 1], b = rest[k];
          const double changed =
              without + between[a][piece.front()] + between[piece.back()][b] - between[a][b];
          if (!(changed < least)) continue;
          least = changed;
          best = rest;
          best.insert(best.begin() + static_cast<std::ptrdiff_t>(k), piece.begin(), piece.end());
        }
      }
    }
  }
  if (best.empty()) return false;
  order = best;
  return true;
}

}  // namespace

double length_of(const std::vector<std::size_t>& order,
                 const std::vector<std::vector<double>>& between) {
  double length = 0.0;
  for (std::size_t i = 1; i < order.size(); ++i) length += between[order[i - 1]][order[i]];
  return length;
}

std::vector<std::size_t> visiting_order(const std::vector<std::vector<double>>& between) {
  if (between.size() < 2) return Order(between.size(), 0);
  Order order = insert_cheapest(between);
  while (improve(order, between)) {
  }
  return order;
}

}  // namespace swiftlet
