// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/system/system_test.hpp"

namespace swiftlet::test {

/// This build, installed into a folder of its own, and projects that know it by CMAKE_PREFIX_PATH
/// alone.
class PackageTest : public SystemTest {
 protected:
  PackageTest();

  /// Takes the files `names` of a project from a README: the code blocks whose first line is a
  /// comment that begins with the file's name.
  void extract(const std::string& project, const std::string& readme,
               const std::vector<std::string>& names) const;
  Finished configure(const std::string& project, const Arguments& options = {});
  /// Configures and builds, which must go well.
  void build(const std::string& project);
  /// Runs a program that was built.
  Finished run_built(const std::string& project, const Arguments& command);
  /// Runs a command to its end; exit code -1 where it does not come in time.
  Finished run_command(const Arguments& command);

  std::string prefix() const { return path("prefix"); }
};

}  // namespace swiftlet::test
