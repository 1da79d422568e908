// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/shell/curses_terminal.hpp"

#define NCURSES_NOMACROS 1
#define NCURSES_WIDECHAR 1
#include <curses.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <optional>

#include "gcs/screen/shell/locale_text.hpp"
#include "gcs/screen/shell/terminal_rescue.hpp"

namespace swiftlet::screen {
namespace {

constexpr int kEscapeDelayMs = 25;  // a sequence of a key arrives in one piece
constexpr wint_t kRedraw = 'L' - '@';

short colour_of(Hue hue) {
  switch (hue) {
    case Hue::kDefault:
      return -1;
    case Hue::kRed:
      return COLOR_RED;
    case Hue::kGreen:
      return COLOR_GREEN;
    case Hue::kYellow:
      return COLOR_YELLOW;
    case Hue::kBlue:
      return COLOR_BLUE;
    case Hue::kMagenta:
      return COLOR_MAGENTA;
    case Hue::kCyan:
      return COLOR_CYAN;
  }
  return -1;
}

short pair_of(Hue hue) {
  return static_cast<short>(hue);
}

std::optional<KeyCode> special_key(wint_t code) {
  switch (code) {
    case KEY_UP:
      return KeyCode::kUp;
    case KEY_DOWN:
      return KeyCode::kDown;
    case KEY_LEFT:
      return KeyCode::kLeft;
    case KEY_RIGHT:
      return KeyCode::kRight;
    case KEY_ENTER:
      return KeyCode::kEnter;
    case KEY_BACKSPACE:
      return KeyCode::kBackspace;
    case KEY_DC:
      return KeyCode::kDelete;
    case KEY_BTAB:
      return KeyCode::kBackTab;
    default:
      return std::nullopt;
  }
}

std::optional<KeyCode> character_key(wint_t character) {
  switch (character) {
    case '\r':
    case '\n':
      return KeyCode::kEnter;
    case '\x1b':
      return KeyCode::kEscape;
    case '\x7f':
    case '\b':
      return KeyCode::kBackspace;
    case '\x15':
      return KeyCode::kEraseLine;
    case '\t':
      return KeyCode::kTab;
    default:
      break;
  }
  if (character < ' ') return std::nullopt;
  return key_code(static_cast<char32_t>(character));
}

}  // namespace

CursesTerminal::CursesTerminal(const Options& options) {
  if (isatty(STDIN_FILENO) != 1 || isatty(STDOUT_FILENO) != 1) {
    throw NoTerminal(
        "there is no terminal to draw in; for scripts there are verbs: swiftlet gcs --help");
  }
  ascii_ = !locale_is_utf8() || options.ascii;
  rescue_terminal_at_end();
  if (newterm(nullptr, stdout, stdin) == nullptr) {
    forget_rescue();
    const char* term = std::getenv("TERM");
    throw NoTerminal(fmt::format(
        "the terminal '{}' is not known or cannot move its cursor; set TERM, for instance to vt100",
        term == nullptr ? "" : term));
  }
  set_escdelay(kEscapeDelayMs);
  cbreak();
  noecho();
  nonl();
  keypad(stdscr, TRUE);
  nodelay(stdscr, TRUE);
  curs_set(0);
  colours_ = options.colours && has_colors() && start_color() == OK;
  if (!colours_) return;
  const short background = use_default_colors() == OK ? -1 : COLOR_BLACK;
  for (const Hue hue :
       {Hue::kRed, Hue::kGreen, Hue::kYellow, Hue::kBlue, Hue::kMagenta, Hue::kCyan}) {
    init_pair(pair_of(hue), colour_of(hue), background);
  }
}

CursesTerminal::~CursesTerminal() {
  endwin();
  forget_rescue();
}

int CursesTerminal::width() const {
  return getmaxx(stdscr);
}
int CursesTerminal::height() const {
  return getmaxy(stdscr);
}

std::vector<KeyCode> CursesTerminal::keys() {
  std::vector<KeyCode> keys;
  wint_t code = 0;
  for (int kind = get_wch(&code); kind != ERR; kind = get_wch(&code)) {
    if (kind == KEY_CODE_YES && code == KEY_RESIZE) {
      shown_ = Surface(0, 0);
    } else if (kind == OK && code == kRedraw) {
      clearok(stdscr, TRUE);
      shown_ = Surface(0, 0);
    } else if (const auto key = kind == KEY_CODE_YES ? special_key(code) : character_key(code)) {
      keys.push_back(*key);
    }
  }
  return keys;
}

void CursesTerminal::show(const Surface& surface) {
  const bool same_size = surface.width() == shown_.width() && surface.height() == shown_.height();
  if (!same_size) erase();
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      const Cell& cell = surface.at(x, y);
      if (!same_size || !(cell == shown_.at(x, y))) put(x, y, cell);
    }
  }
  shown_ = surface;
  refresh();
}

void CursesTerminal::put(int x, int y, const Cell& cell) const {
  const Style& style = cell.style;
  attr_t attributes = A_NORMAL;
  if (style.bold) attributes |= A_BOLD;
  if (style.dim) attributes |= A_DIM;
  if (style.inverse) attributes |= A_REVERSE;
  const short pair = colours_ ? pair_of(style.hue) : short{0};
  const auto glyph = static_cast<wchar_t>(ascii_ ? ascii_of(cell.glyph) : cell.glyph);
  const wchar_t text[] = {glyph, L'\0'};
  cchar_t complex{};
  setcchar(&complex, text, attributes, pair, nullptr);
  mvadd_wch(y, x, &complex);
}

}  // namespace swiftlet::screen
