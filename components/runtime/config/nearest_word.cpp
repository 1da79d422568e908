// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/config/nearest_word.hpp"

#include <algorithm>
#include <numeric>

namespace swiftlet {

std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates) {
  // Levenshtein distance, one row at a time.
  const auto distance = [&word](const std::string& other) {
    std::vector<std::size_t> row(other.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 1; i <= word.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i;
      for (std::size_t j = 1; j <= other.size(); ++j) {
        const std::size_t substitute = diagonal + (word[i - 1] == other[j - 1] ? 0 : 1);
        diagonal = row[j];
        row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
      }
    }
    return row.back();
  };
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    // "yaw" is short for "yaw_deg" rather than a mistake for "y".
    const bool is_begun = word.size() > 1 && candidate.compare(0, word.size(), word) == 0;
    if (is_begun) return candidate;
    const std::size_t d = distance(candidate);
    if (d < best_distance) {
      best_distance = d;
      best = candidate;
    }
  }
  return best;
}

}  // namespace swiftlet
