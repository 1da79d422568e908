// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/drawing/surface.hpp"

#include <algorithm>

namespace swiftlet::screen {

Surface::Surface(int width, int height)
    : width_(std::max(width, 0)),
      height_(std::max(height, 0)),
      cells_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

void Surface::put(int x, int y, char32_t glyph, Style style) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  cells_[index(x, y)] = {glyph, style};
}

void Surface::clear() {
  std::fill(cells_.begin(), cells_.end(), Cell{});
}

Pane::Pane(Surface& surface, const Area& area) : surface_(&surface), area_(area) {
  area_.width = std::max(area_.width, 0);
  area_.height = std::max(area_.height, 0);
}

Pane Pane::part(const Area& area) const {
  const int width = std::min(area.width, area_.width - area.x);
  const int height = std::min(area.height, area_.height - area.y);
  return {*surface_, {area_.x + area.x, area_.y + area.y, width, height}};
}

void Pane::put(int x, int y, char32_t glyph, Style style) const {
  if (x < 0 || y < 0 || x >= area_.width || y >= area_.height) return;
  surface_->put(area_.x + x, area_.y + y, glyph, style);
}

int Pane::text(int x, int y, std::string_view utf8, Style style, int columns) const {
  const std::u32string glyphs = decode(utf8);
  const int room = std::min(columns, area_.width - x);
  if (room <= 0) return x;
  const bool fits = static_cast<int>(glyphs.size()) <= room;
  const int shown = fits ? static_cast<int>(glyphs.size()) : room - 1;
  for (int i = 0; i < shown; ++i) put(x + i, y, glyphs[static_cast<std::size_t>(i)], style);
  if (!fits) put(x + shown, y, U'…', style);
  return x + (fits ? shown : room);
}

void Pane::text_before(int end, int y, std::string_view utf8, Style style) const {
  text(std::max(end - columns_of(utf8), 0), y, utf8, style);
}

void Pane::fill(char32_t glyph, Style style) const {
  for (int y = 0; y < area_.height; ++y) {
    for (int x = 0; x < area_.width; ++x) put(x, y, glyph, style);
  }
}

void Pane::horizontal(int y, Style style) const {
  for (int x = 0; x < area_.width; ++x) put(x, y, U'─', style);
}

void Pane::vertical(int x, Style style) const {
  for (int y = 0; y < area_.height; ++y) put(x, y, U'│', style);
}

void Pane::box(std::string_view title, Style style) const {
  const int right = area_.width - 1;
  const int bottom = area_.height - 1;
  horizontal(0, style);
  horizontal(bottom, style);
  vertical(0, style);
  vertical(right, style);
  put(0, 0, U'┌', style);
  put(right, 0, U'┐', style);
  put(0, bottom, U'└', style);
  put(right, bottom, U'┘', style);
  if (title.empty()) return;
  const int end = text(2, 0, " " + std::string(title), kBold, area_.width - 5);
  put(end, 0, U' ', style);
}

std::string to_text(const Surface& surface, bool ascii) {
  std::string text;
  for (int y = 0; y < surface.height(); ++y) {
    std::string line;
    for (int x = 0; x < surface.width(); ++x) {
      const char32_t glyph = surface.at(x, y).glyph;
      line += ascii ? std::string(1, ascii_of(glyph)) : encode(glyph);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace swiftlet::screen
