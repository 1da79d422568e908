// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gcs/screen/drawing/surface.hpp"

namespace swiftlet::screen {

/// A bar of `columns`, filled to `share` (0 to 1).
void draw_bar(const Pane& pane, int x, int y, int columns, double share, Style style);

/// A text in lines, each at most `columns` wide; they break between words, and in a word that is
/// longer.
std::vector<std::string> wrap(const std::string& text, int columns);

/// A line of a list, with how it looks.
struct Line {
  std::string text;
  Style style;
};
/// The last lines that fit, the newest at the bottom.
void draw_tail(const Pane& pane, const std::vector<Line>& lines);
/// The lines around `selected`, so that it is always to be seen.
void draw_list(const Pane& pane, const std::vector<Line>& lines, int selected);

/// A dialog in the middle of a pane, on top of what is there: the pane inside its frame.
Pane draw_dialog(const Pane& pane, const std::string& title, int width, int height);

}  // namespace swiftlet::screen
