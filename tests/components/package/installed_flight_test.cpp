// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The program and its scenarios, from where they are installed.
#include "tests/components/package/consumer.hpp"

namespace swiftlet::test {
namespace {

using testing::HasSubstr;

TEST_F(PackageTest, TheInstalledProgramFliesTheInstalledOffice) {
  const std::string program = prefix() + "/bin/swiftlet";
  const std::string share = prefix() + "/share/swiftlet";
  const Finished flown = run_command(
      {program, "fly", share + "/sim/scenarios/office.yaml", "--report", path("report")});
  EXPECT_EQ(flown.exit_code, 0) << flown.err;
  EXPECT_EQ(read_report(path("report"))["success"], true) << flown.out;

  const Finished launched =
      run_command({program, "launch", share + "/launch/office.yaml", "--dry-run"});
  EXPECT_EQ(launched.exit_code, 0) << launched.err;
  EXPECT_THAT(launched.out, HasSubstr(program + " run sim --scenario " + share));
}

}  // namespace
}  // namespace swiftlet::test
