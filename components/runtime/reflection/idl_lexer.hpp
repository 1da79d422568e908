// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "components/runtime/reflection/idl_files.hpp"

namespace swiftlet {

/// A word, a number, a literal, `::` or a single character of punctuation. The last token of a
/// file has an empty text.
struct IdlToken {
  std::string text;
  std::size_t begin = 0;  ///< in the text without comments
  std::size_t end = 0;
  bool is_word = false;
};

/// The text with blanks in place of comments and of preprocessor lines, so that positions stay.
std::string without_comments(const std::string& text);

std::vector<IdlToken> idl_tokens(const std::string& text_without_comments);

}  // namespace swiftlet
