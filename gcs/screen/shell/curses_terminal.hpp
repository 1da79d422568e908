// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <vector>

#include "gcs/screen/drawing/surface.hpp"
#include "gcs/screen/state/key_code.hpp"

namespace swiftlet::screen {

/// There is no terminal, or it cannot do what is needed; says which and why.
class NoTerminal : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The terminal as a screen of cells, by ncurses. One at a time. Whatever ends the process (but
/// SIGKILL), the terminal is as before.
class CursesTerminal {
 public:
  struct Options {
    bool ascii = false;   ///< also where the locale has UTF-8
    bool colours = true;  ///< where the terminal has them
  };
  /// Throws NoTerminal.
  explicit CursesTerminal(const Options& options);
  ~CursesTerminal();
  CursesTerminal(const CursesTerminal&) = delete;
  CursesTerminal& operator=(const CursesTerminal&) = delete;

  int width() const;
  int height() const;
  bool ascii() const { return ascii_; }
  /// Those pressed since the last call. A change of size is taken note of here.
  std::vector<KeyCode> keys();
  /// Writes what differs from what is there.
  void show(const Surface& surface);

 private:
  void put(int x, int y, const Cell& cell) const;

  bool ascii_;
  bool colours_;
  Surface shown_{0, 0};
};

}  // namespace swiftlet::screen
