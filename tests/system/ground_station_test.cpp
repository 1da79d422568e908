// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <cctype>
#include <iterator>
#include <sstream>

#include "tests/system/system_test.hpp"

namespace swiftlet::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class GroundStationAlone : public SystemTest, public testing::WithParamInterface<std::string> {};

std::vector<std::string> words(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

TEST_P(GroundStationAlone, SaysWithinTwoSecondsThatNobodyAnswers) {
  std::vector<std::string> arguments = words(GetParam());
  arguments.insert(arguments.begin(), "gcs");
  const Finished finished = run(arguments);
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_THAT(finished.err, HasSubstr("domain " + std::to_string(domain())));
  EXPECT_THAT(finished.err, HasSubstr("is a commander running there"));
  EXPECT_THAT(finished.out, IsEmpty());
  // Two seconds are promised; the third is for starting and scheduling on a machine that is busy.
  EXPECT_LT(finished.duration.count(), 3.0 * kSlowdown);
}

/// "goto 2 4" is called goto24.
std::string name_of_verb(const testing::TestParamInfo<std::string>& verb) {
  std::string name;
  for (const char c : verb.param) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(EachVerb, GroundStationAlone,
                         testing::Values("arm", "disarm", "takeoff", "takeoff 1.5", "goto 2 4",
                                         "goto 2 4 1", "hover", "land", "status", "status --json",
                                         "mode", "mode --json", "mode hover", "log --for 1.5"),
                         name_of_verb);

class BadMission : public SystemTest, public testing::WithParamInterface<std::string> {};

TEST_P(BadMission, ThatNobodyCouldFlyNeedsNoNetworkToBeRefused) {
  const std::string file = write("bad.yaml",
                                 "items:\n  - takeoff: 1.2\n  - land\n"
                                 "  - goto: {x: 1, y: 1, z: 1.2}\n");
  Arguments arguments = words(GetParam());
  arguments.insert(arguments.begin(), "gcs");
  arguments.insert(arguments.end(), {file, "--network", "nothing0"});
  const Finished finished = run(arguments);
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_THAT(finished.err, HasSubstr(file + ":4: item 3: error: it stands behind the landing"));
  EXPECT_THAT(finished.err, Not(HasSubstr("nothing0")));
}

INSTANTIATE_TEST_SUITE_P(Sent, BadMission, testing::Values("mission upload", "follow"),
                         name_of_verb);

}  // namespace
}  // namespace swiftlet::test
