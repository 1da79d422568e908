// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gcs/screen/drawing/surface.hpp"

namespace swiftlet::screen {

/// The braille pattern without dots; a pattern's dots are its lowest eight bits.
inline constexpr char32_t kBraille = 0x2800;

/// Dots, 2 x 4 in a cell, so that they are about square. Each dot has a layer; a cell has the style
/// of the highest layer in it.
class Braille {
 public:
  /// Dots in a cell.
  static constexpr int kAcross = 2;
  static constexpr int kDown = 4;

  /// Columns and rows of the terminal.
  Braille(int width, int height);
  int width() const { return width_ * kAcross; }  ///< dots
  int height() const { return height_ * kDown; }  ///< dots
  /// From the upper left corner; outside: nothing happens.
  void dot(int x, int y, int layer = 0);
  /// Ends may be far outside.
  void line(double x0, double y0, double x1, double y1, int layer = 0);
  bool has(int x, int y) const;
  /// Puts the cells that have dots; `styles` by layer.
  void draw(const Pane& pane, const std::vector<Style>& styles) const;

 private:
  struct Dots {
    unsigned bits = 0;
    int layer = 0;
  };
  int width_;
  int height_;
  std::vector<Dots> cells_;
};

}  // namespace swiftlet::screen
