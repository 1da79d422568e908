// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace swiftlet::screen {

/// A key of the keyboard: its character, or one of those without, beyond all characters.
enum class KeyCode : char32_t {
  kUp = 0x110000,
  kDown,
  kLeft,
  kRight,
  kEnter,
  kEscape,
  kBackspace,
  kEraseLine,
  kDelete,
  kTab,
  kBackTab,
};
constexpr KeyCode key_code(char32_t character) {
  return static_cast<KeyCode>(character);
}
/// A character that can be written into a text.
constexpr bool is_printable(KeyCode key) {
  return key >= key_code(' ') && key < key_code(0x7F);
}

}  // namespace swiftlet::screen
