// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace swiftlet {

/// How many bytes of `text` to keep, `longest` at most, so that no character of UTF-8 is cut. What
/// is no UTF-8 is cut where it falls.
inline std::size_t utf8_cut(const std::string& text, std::size_t longest) {
  if (text.size() <= longest) return text.size();
  const auto continues = [&text](std::size_t at) {
    return (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
  };
  std::size_t at = longest;
  for (int back = 0; back < 3 && at > 0 && continues(at); ++back) --at;
  return continues(at) ? longest : at;
}

}  // namespace swiftlet
