// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// What glyphs are in UTF-8 and in ASCII.
#include "gcs/screen/drawing/braille.hpp"
#include "gcs/screen/drawing/surface.hpp"

namespace swiftlet::screen {
namespace {

constexpr char32_t kReplacement = U'\uFFFD';

struct Substitute {
  char32_t glyph;
  char ascii;
};
constexpr Substitute kSubstitutes[] = {
    {U'─', '-'},  {U'│', '|'}, {U'┌', '+'}, {U'┐', '+'}, {U'└', '+'},  {U'┘', '+'}, {U'├', '+'},
    {U'┤', '+'},  {U'┬', '+'}, {U'┴', '+'}, {U'┼', '+'}, {U'↑', '^'},  {U'↗', '/'}, {U'→', '>'},
    {U'↘', '\\'}, {U'↓', 'v'}, {U'↙', '/'}, {U'←', '<'}, {U'↖', '\\'}, {U'█', '#'}, {U'░', '.'},
    {U'·', '.'},  {U'…', '~'}, {U'°', ' '}, {U'▸', '>'}, {U'●', '*'},  {U'✛', '+'}, {U'²', '2'},
    {U'━', '='},  {U'╋', '+'}, {U'▏', '|'}, {U'▕', '|'}, {U'×', 'x'}};

char ascii_of_dots(int dots) {
  if (dots == 0) return ' ';
  if (dots == 1) return '.';
  if (dots == 2) return ':';
  return dots <= 4 ? '+' : '#';
}

int ones(unsigned bits) {
  int count = 0;
  for (; bits != 0; bits &= bits - 1) ++count;
  return count;
}

/// How many bytes follow the first one of a character; -1 where it is none.
int bytes_that_follow(unsigned char first) {
  if (first < 0x80) return 0;
  if (first >= 0xC2 && first < 0xE0) return 1;
  if (first >= 0xE0 && first < 0xF0) return 2;
  if (first >= 0xF0 && first < 0xF5) return 3;
  return -1;
}

}  // namespace

std::u32string decode(std::string_view utf8) {
  std::u32string glyphs;
  for (std::size_t i = 0; i < utf8.size();) {
    const auto first = static_cast<unsigned char>(utf8[i++]);
    int follow = bytes_that_follow(first);
    if (follow < 0 || first < 0x20 || first == 0x7F) {
      glyphs += kReplacement;
      continue;
    }
    char32_t glyph = follow == 0 ? first : first & (0x3Fu >> follow);
    for (; follow > 0 && i < utf8.size(); --follow, ++i) {
      const auto next = static_cast<unsigned char>(utf8[i]);
      if ((next & 0xC0u) != 0x80u) break;
      glyph = (glyph << 6) | (next & 0x3Fu);
    }
    // C1 controls move the cursor on some terminals.
    const bool is_control = glyph >= 0x80 && glyph < 0xA0;
    glyphs += follow > 0 || is_control ? kReplacement : glyph;
  }
  return glyphs;
}

std::string encode(char32_t glyph) {
  const auto byte = [](char32_t bits) { return static_cast<char>(bits); };
  if (glyph < 0x80) return {byte(glyph)};
  const char last = byte(0x80 | (glyph & 0x3F));
  if (glyph < 0x800) return {byte(0xC0 | glyph >> 6), last};
  const char third = byte(0x80 | ((glyph >> 6) & 0x3F));
  if (glyph < 0x10000) return {byte(0xE0 | glyph >> 12), third, last};
  return {byte(0xF0 | glyph >> 18), byte(0x80 | ((glyph >> 12) & 0x3F)), third, last};
}

int columns_of(std::string_view utf8) {
  return static_cast<int>(decode(utf8).size());
}

char ascii_of(char32_t glyph) {
  if (glyph >= U' ' && glyph < 0x7F) return static_cast<char>(glyph);
  if (glyph >= kBraille && glyph < kBraille + 256) {
    return ascii_of_dots(ones(static_cast<unsigned>(glyph - kBraille)));
  }
  for (const Substitute& substitute : kSubstitutes) {
    if (substitute.glyph == glyph) return substitute.ascii;
  }
  return '?';
}

std::string printable(std::string_view utf8, bool ascii) {
  std::string text;
  for (const char32_t glyph : decode(utf8)) {
    text += ascii ? std::string(1, ascii_of(glyph)) : encode(glyph);
  }
  return text;
}

}  // namespace swiftlet::screen
