// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/drawing/widgets.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace swiftlet::screen {

void draw_bar(const Pane& pane, int x, int y, int columns, double share, Style style) {
  const double known = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0;
  const int full = static_cast<int>(std::lround(known * columns));
  for (int i = 0; i < columns; ++i) {
    pane.put(x + i, y, i < full ? U'█' : U'░', i < full ? style : kDim);
  }
}

std::vector<std::string> wrap(const std::string& text, int columns) {
  const int width = std::max(columns, 1);
  std::vector<std::string> lines;
  std::istringstream words(text);
  std::string word;
  while (words >> word) {
    const bool begins = lines.empty() || columns_of(lines.back()) + 1 + columns_of(word) > width;
    if (begins) {
      lines.push_back("");
    } else {
      lines.back() += " ";
    }
    for (const char32_t glyph : decode(word)) {
      if (columns_of(lines.back()) >= width) lines.push_back("");
      lines.back() += encode(glyph);
    }
  }
  return lines;
}

void draw_tail(const Pane& pane, const std::vector<Line>& lines) {
  const int shown = std::min(pane.height(), static_cast<int>(lines.size()));
  for (int i = 0; i < shown; ++i) {
    const Line& line = lines[lines.size() - static_cast<std::size_t>(shown - i)];
    pane.text(0, i, line.text, line.style);
  }
}

void draw_list(const Pane& pane, const std::vector<Line>& lines, int selected) {
  const int count = static_cast<int>(lines.size());
  const int latest = std::max(0, count - pane.height());
  const int first = std::clamp(selected - pane.height() / 2, 0, latest);
  for (int y = 0; y < pane.height() && first + y < count; ++y) {
    const Line& line = lines[static_cast<std::size_t>(first + y)];
    pane.text(0, y, line.text, line.style);
  }
}

Pane draw_dialog(const Pane& pane, const std::string& title, int width, int height) {
  const int shown_width = std::min(width, pane.width());
  const int shown_height = std::min(height, pane.height());
  const Pane frame = pane.part({(pane.width() - shown_width) / 2,
                                (pane.height() - shown_height) / 2, shown_width, shown_height});
  frame.fill(U' ');
  frame.box(title);
  return frame.part({2, 1, shown_width - 4, shown_height - 2});
}

}  // namespace swiftlet::screen
