// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "estimation/basics/time.hpp"

namespace swiftlet::carmen {

/// The fields of one line, from left to right. The first that cannot be used is remembered in
/// problem(); everything read after it is zero.
class LineFields {
 public:
  explicit LineFields(std::string_view line) : rest_(line) {}

  bool ok() const { return problem_.empty(); }
  /// "field 7 (\"abc\") is no number"; empty where all went well.
  const std::string& problem() const { return problem_; }

  bool at_end();
  /// The next word; `what` names it in problem() where there is none.
  std::string_view word(const char* what);
  /// A finite number of at most 1e12.
  double number(const char* what);
  /// A whole number from 0 to `max`.
  std::size_t count(const char* what, std::size_t max);
  /// Seconds, to the last digit that is written: a double has only microseconds at 1e9 s.
  Time time(const char* what);

 private:
  void fail(std::string problem);
  std::string place(std::string_view text, const char* what) const;

  std::string_view rest_;
  int index_ = 0;
  std::string problem_;
};

}  // namespace swiftlet::carmen
