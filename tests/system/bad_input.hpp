// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Input that cannot be used: what the program must do with it.
#pragma once

#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "tests/system/system_test.hpp"

namespace swiftlet::test {

/// One thing that a user did wrong. "{in}" in arguments stands for a folder with the files of the
/// test, "{out}" for an empty one.
struct BadInput {
  std::string name;
  std::vector<std::string> arguments;
  std::vector<std::string> says;  ///< all of these are in what the program writes to stderr
  std::map<std::string, std::string> files = {};  ///< in {in}: contents by name
  Process::Environment environment = {};
};
std::ostream& operator<<(std::ostream& out, const BadInput& input);
std::string name_of(const testing::TestParamInfo<BadInput>& info);

class BadInputTest : public SystemTest {
 protected:
  BadInputTest();
  /// Exit code 2, the reason and the remedy on stderr, in a line or two, and nothing written.
  void expect_refused(const BadInput& input);
  /// Arguments with the folders in place.
  Arguments expand(const Arguments& arguments) const;
  std::vector<std::string> left_behind() const;
};

}  // namespace swiftlet::test
