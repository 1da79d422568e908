// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// What a person is asked, told, and may press.
#include <fmt/format.h>

#include <algorithm>

#include "gcs/screen/panels.hpp"

namespace swiftlet::screen {
namespace {

constexpr Style kQuestion{Hue::kYellow, true, false, true};

/// The end of what is written, where not all of it has room.
std::string end_of(const std::string& text, int columns) {
  if (columns_of(text) <= columns) return text;
  const std::u32string glyphs = decode(text);
  std::string end = "…";
  for (std::size_t i = glyphs.size() - static_cast<std::size_t>(std::max(columns - 1, 0));
       i < glyphs.size(); ++i) {
    end += encode(glyphs[i]);
  }
  return end;
}

bool is_on(const Binding& binding, Keyboard keyboard) {
  const auto& all = binding.keyboards;
  return std::find(all.begin(), all.end(), keyboard) != all.end();
}

}  // namespace

void paint_message(const Pane& pane, const GroundStationModel& model, const Controller& controller,
                   Time now) {
  switch (controller.keyboard()) {
    case Keyboard::kText: {
      const int x = pane.text(1, 0, controller.prompt() + " ", kQuestion);
      pane.text(x, 0, end_of(controller.text() + "_", pane.width() - x), kQuestion);
      return;
    }
    case Keyboard::kConfirm:
      pane.text(1, 0, controller.prompt() + "  y yes, n no", kQuestion);
      return;
    case Keyboard::kSticks: {
      const Sticks sticks = controller.sticks(now).value_or(Sticks{});
      pane.text(1, 0,
                fmt::format("{}: forward {:+.0f} left {:+.0f} up {:+.0f} turn {:+.0f}",
                            sticks.assisted ? "Assisted" : "Manual", sticks.forward, sticks.left,
                            sticks.up, sticks.turn),
                kBold);
      const int x = std::max(46, pane.width() / 2);
      pane.text(x, 0, model.command().text, style_of(model.command().severity));
      return;
    }
    default:
      pane.text(1, 0, model.command().text, style_of(model.command().severity));
  }
}

void paint_hints(const Pane& pane, const Controller& controller) {
  const Keyboard keyboard = controller.keyboard();
  const bool steers = keyboard == Keyboard::kSticks;
  const Style key_style{Hue::kDefault, true, false, steers};
  const Style word_style{Hue::kDefault, false, !steers, steers};
  if (steers) pane.fill(U' ', kInverse);
  int x = 1;
  if (keyboard != Keyboard::kFly) {
    x = pane.text(x, 0, to_string(keyboard), {Hue::kDefault, true, false, true}) + 2;
  }
  if (steers) x = pane.text(x, 0, "w s a d  i k  j l  m switch", word_style) + 2;
  const bool has_help = find_binding(keyboard, key_code('?')) != nullptr;
  const int end = pane.width() - (has_help ? 8 : 1);
  for (const Binding& binding : key_bindings()) {
    if (!is_on(binding, keyboard) || *binding.hint == '\0') continue;
    const std::string_view keys(binding.label);
    const std::string_view first = keys.substr(0, keys.find(' '));
    if (x + columns_of(first) + 1 + columns_of(binding.hint) > end) break;
    x = pane.text(x, 0, first, key_style);
    x = pane.text(x + 1, 0, binding.hint, word_style) + 2;
  }
  if (!has_help) return;
  pane.text(pane.width() - 7, 0, "?", key_style);
  pane.text(pane.width() - 5, 0, "help", word_style);
}

void paint_help(const Pane& pane, Keyboard keyboard) {
  constexpr int kKeys = 9;
  std::vector<const Binding*> rows;
  for (const Binding& binding : key_bindings()) {
    if (is_on(binding, keyboard)) rows.push_back(&binding);
  }
  const int columns = static_cast<int>(rows.size()) > pane.height() ? 2 : 1;
  const int width = pane.width() / columns;
  const int each = (static_cast<int>(rows.size()) + columns - 1) / columns;
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    const Binding& binding = *rows[static_cast<std::size_t>(i)];
    const int x = i / each * width;
    pane.text(x, i % each, binding.label, kBold);
    pane.text(x + kKeys, i % each, binding.what, kPlain, width - kKeys - 1);
  }
}

}  // namespace swiftlet::screen
