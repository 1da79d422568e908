// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace swiftlet {

/// A key: its character, or one of those without.
enum class Key : char { kLeft = '\1', kRight = '\2' };
constexpr Key key(char character) {
  return static_cast<Key>(character);
}

/// The keys in what a terminal sent, its sequences for arrows included; sequences for other keys
/// are left out. An incomplete sequence at the end stays in `input`.
std::vector<Key> take_keys(std::string& input);

/// The terminal in which a command runs, if it does: keys at once and without echo, and one line
/// about how things are, which is written over again and again. Only one at a time.
///
/// Whatever ends or stops the process (but SIGKILL), the terminal is as before. Handlers of SIGINT
/// and SIGTERM that were there before are called, too.
class Terminal {
 public:
  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Somebody can press keys: standard input is a terminal, and we are in its foreground.
  bool has_keys() const { return has_keys_; }
  /// Somebody can see a status: standard output is a terminal.
  bool has_status() const { return has_status_; }

  /// Those pressed since the last call.
  std::vector<Key> keys();
  /// Replaces the status line; it is cut where the terminal ends.
  void show(const std::string& status);
  /// Removes the status line, so that something else can be written.
  void clear();

 private:
  bool has_keys_ = false;
  bool has_status_ = false;
  bool shown_ = false;
  std::string input_;
};

}  // namespace swiftlet
