// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace swiftlet {

/// A short way through places: from the first of `between` to each of the others once, and to the
/// last of it at the end. `between[i][j]` is the length from i to j, the same back. Cheapest
/// insertion, then pieces of the way are moved and reversed (or-opt, 2-opt) until nothing gets
/// shorter. The order begins with 0 and ends with the last index; deterministic.
std::vector<std::size_t> visiting_order(const std::vector<std::vector<double>>& between);

/// The length of a way in that order.
double length_of(const std::vector<std::size_t>& order,
                 const std::vector<std::vector<double>>& between);

}  // namespace swiftlet
