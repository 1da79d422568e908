// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace swiftlet {

/// The candidate that `word` is short for, else the nearest by edit distance; "" when none is near
/// enough to be meant.
std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace swiftlet
