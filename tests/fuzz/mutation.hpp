// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <vector>

namespace swiftlet::fuzz {

using Bytes = std::vector<std::uint8_t>;

/// `seed` with one to four changes: flipped bits, numbers that break arithmetic, parts that are cut
/// off, doubled, filled in, or taken from `other`. At most `limit` bytes. The same `random` gives
/// the same bytes.
Bytes mutated(const Bytes& seed, const Bytes& other, std::size_t limit, std::mt19937& random);

}  // namespace swiftlet::fuzz
