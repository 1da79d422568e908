// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace swiftlet {

/// Why a file cannot be used, and on which of its lines, from 1. Readers throw it among themselves;
/// whoever called them hears it as an Error that names the file.
class LineProblem : public std::runtime_error {
 public:
  LineProblem(int line, const std::string& problem) : runtime_error(problem), line_(line) {}
  int line() const { return line_; }

 private:
  int line_;
};

}  // namespace swiftlet
