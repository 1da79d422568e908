// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Drawing in cells of a terminal: values and a size go in, glyphs come out. Knows no terminal.
namespace swiftlet::screen {

enum class Hue : std::uint8_t { kDefault, kRed, kGreen, kYellow, kBlue, kMagenta, kCyan };

struct Style {
  Hue hue = Hue::kDefault;
  bool bold = false;
  bool dim = false;
  bool inverse = false;
  bool operator==(const Style& other) const {
    return hue == other.hue && bold == other.bold && dim == other.dim && inverse == other.inverse;
  }
};

inline constexpr Style kPlain{};
inline constexpr Style kDim{Hue::kDefault, false, true, false};
inline constexpr Style kBold{Hue::kDefault, true, false, false};
inline constexpr Style kGood{Hue::kGreen, false, false, false};
inline constexpr Style kWarning{Hue::kYellow, true, false, false};
inline constexpr Style kAlarm{Hue::kRed, true, false, false};
inline constexpr Style kInverse{Hue::kDefault, false, false, true};

/// One place on the screen. Every glyph is one column wide.
struct Cell {
  char32_t glyph = U' ';
  Style style;
  bool operator==(const Cell& other) const { return glyph == other.glyph && style == other.style; }
};

/// Columns and rows, from the upper left corner.
struct Area {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

/// A picture in cells.
class Surface {
 public:
  Surface(int width, int height);
  int width() const { return width_; }
  int height() const { return height_; }
  /// Must be inside.
  const Cell& at(int x, int y) const { return cells_[index(x, y)]; }
  /// Outside: nothing happens.
  void put(int x, int y, char32_t glyph, Style style);
  void clear();

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  int width_;
  int height_;
  std::vector<Cell> cells_;
};

/// A part of a surface with its own origin; what is drawn outside of it is cut off. The surface
/// outlives it.
class Pane {
 public:
  Pane(Surface& surface, const Area& area);
  explicit Pane(Surface& surface) : Pane(surface, {0, 0, surface.width(), surface.height()}) {}
  /// A part of this one, cut off where this one ends.
  Pane part(const Area& area) const;

  int width() const { return area_.width; }
  int height() const { return area_.height; }
  void put(int x, int y, char32_t glyph, Style style = kPlain) const;
  /// UTF-8. What does not fit into `columns` (or the pane) ends in an ellipsis. Returns the column
  /// after the text.
  int text(int x, int y, std::string_view utf8, Style style = kPlain, int columns = 1 << 20) const;
  /// So that it ends before column `end`.
  void text_before(int end, int y, std::string_view utf8, Style style = kPlain) const;
  void fill(char32_t glyph, Style style = kPlain) const;
  void horizontal(int y, Style style = kDim) const;
  void vertical(int x, Style style = kDim) const;
  /// A frame along the edge, with a title in its upper side.
  void box(std::string_view title, Style style = kPlain) const;

 private:
  Surface* surface_;
  Area area_;
};

/// The code points of UTF-8; U+FFFD for what is none, and for control characters.
std::u32string decode(std::string_view utf8);
std::string encode(char32_t glyph);
/// How many columns it takes.
int columns_of(std::string_view utf8);

/// The ASCII character that stands for a glyph where there is no UTF-8: lines become + - |, arrows
/// ^ v < > / \, dots of braille . : + # by their number.
char ascii_of(char32_t glyph);
/// A text as it can be written on a terminal: without control characters, and in ASCII if so.
std::string printable(std::string_view utf8, bool ascii);

/// Lines of text, in UTF-8 or ASCII, without spaces at their ends.
std::string to_text(const Surface& surface, bool ascii = false);

}  // namespace swiftlet::screen
