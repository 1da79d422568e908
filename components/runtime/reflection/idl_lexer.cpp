// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/reflection/idl_lexer.hpp"

#include <algorithm>
#include <cctype>

namespace swiftlet {
namespace {

bool is_blank(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}
bool is_word_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// Behind the literal that begins at `begin` with a quote; the end of the text where it has none.
std::size_t end_of_literal(const std::string& text, std::size_t begin) {
  for (std::size_t i = begin + 1; i < text.size(); ++i) {
    if (text[i] == '\\') {
      ++i;
    } else if (text[i] == text[begin]) {
      return i + 1;
    }
  }
  return text.size();
}

std::size_t end_of_token(const std::string& text, std::size_t begin) {
  const char first = text[begin];
  if (first == '"' || first == '\'') return end_of_literal(text, begin);
  if (text.compare(begin, 2, "::") == 0) return begin + 2;
  if (!is_word_character(first)) return begin + 1;
  std::size_t end = begin;
  const auto is_part = [&](char c) {
    if (is_word_character(c)) return true;
    const bool sign = (c == '+' || c == '-') && (text[end - 1] == 'e' || text[end - 1] == 'E');
    return is_digit(first) && (c == '.' || sign);
  };
  while (end < text.size() && is_part(text[end])) ++end;
  return end;
}

/// Behind the comment or preprocessor line that begins at `begin`; `begin` where there is none.
std::size_t end_of_comment(const std::string& text, std::size_t begin, bool line_start) {
  if (text.compare(begin, 2, "//") == 0 || (line_start && text[begin] == '#')) {
    return std::min(text.find('\n', begin), text.size());
  }
  if (text.compare(begin, 2, "/*") != 0) return begin;
  const std::size_t close = text.find("*/", begin + 2);
  return close == std::string::npos ? text.size() : close + 2;
}

}  // namespace

std::string without_comments(const std::string& text) {
  std::string out = text;
  bool line_start = true;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = end_of_comment(text, i, line_start);
    if (end > i) {
      for (; i < end; ++i) {
        if (text[i] != '\n') out[i] = ' ';
      }
    } else if (text[i] == '"' || text[i] == '\'') {
      i = end_of_literal(text, i);
      line_start = false;
    } else {
      line_start = text[i] == '\n' || (line_start && is_blank(text[i]));
      ++i;
    }
  }
  return out;
}

std::vector<IdlToken> idl_tokens(const std::string& text) {
  std::vector<IdlToken> tokens;
  for (std::size_t at = 0;;) {
    while (at < text.size() && is_blank(text[at])) ++at;
    if (at >= text.size()) break;
    const std::size_t end = end_of_token(text, at);
    const bool is_word = is_word_character(text[at]) && !is_digit(text[at]);
    tokens.push_back({text.substr(at, end - at), at, end, is_word});
    at = end;
  }
  tokens.push_back({"", text.size(), text.size(), false});
  return tokens;
}

}  // namespace swiftlet
