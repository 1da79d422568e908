// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Arguments that cannot be meant.
#include "tests/system/bad_input.hpp"

namespace swiftlet::test {
namespace {

using Arguments = std::vector<std::string>;

BadInput domain_id(const std::string& name, const std::string& value, const Arguments& arguments) {
  return {name,
          arguments,
          {"ROS_DOMAIN_ID is '" + value + "'", "whole number from 0 to 232"},
          {},
          {{"ROS_DOMAIN_ID", value}}};
}

class BadUsage : public BadInputTest, public testing::WithParamInterface<BadInput> {};
TEST_P(BadUsage, IsRefused) {
  expect_refused(GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Verb, BadUsage,
    testing::Values(
        BadInput{"None", {}, {"--help"}},
        BadInput{"Unknown", {"flyy"}, {"unknown verb 'flyy'", "did you mean 'fly'?"}},
        BadInput{"UnknownToAll", {"xylophone"}, {"unknown verb 'xylophone'", "there are", "gcs"}},
        BadInput{"BagNone", {"bag"}, {"--help"}},
        BadInput{"BagUnknown", {"bag", "inof"}, {"unknown verb 'inof'", "did you mean 'info'?"}},
        BadInput{"GcsNone", {"gcs"}, {"--help"}},
        BadInput{"GcsUnknown",
                 {"gcs", "armm"},
                 {"unknown verb 'armm'", "did you mean 'arm'?", "Try: swiftlet gcs --help"}},
        BadInput{"ComponentNone", {"component"}, {"--help"}},
        BadInput{"ConvertUnknown", {"bag", "convert", "ros"}, {"unknown verb 'ros'", "carmen"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Component, BadUsage,
    testing::Values(BadInput{"None", {"run"}, {"components", "required"}},
                    BadInput{"Unknown",
                             {"run", "estimator", "plannner"},
                             {"unknown component 'plannner'", "did you mean 'planner'?"}},
                    BadInput{"UnknownToAll", {"run", "xylophone"}, {"this program has", "planner"}},
                    // Two of a name would both answer.
                    BadInput{"Twice", {"run", "planner", "planner"}, {"'planner'", "twice"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Option, BadUsage,
    testing::Values(
        BadInput{"LogLevel", {"--log", "noisy", "component", "list"}, {"--log", "debug"}},
        BadInput{"Unknown", {"fly", hop(), "--sede", "3"}, {"--sede", "Try: swiftlet fly --help"}},
        BadInput{"SeedNegative", {"fly", hop(), "--seed", "-1"}, {"--seed", "-1"}},
        BadInput{"SeedThatIsText",
                 {"fly", hop(), "--seed", "abc"},
                 {"--seed", "'abc' is no whole number from 0 to 2147483647"}},
        BadInput{"SeedTooLarge", {"fly", hop(), "--seed", "99999999999"}, {"--seed"}},
        BadInput{"RateThatIsNotANumber", {"phone-sim", "--rate", "nan"}, {"--rate", "nan"}},
        BadInput{"PhoneAddress", {"phone-sim", "--to", "nowhere"}, {"--to", "IPv4"}},
        BadInput{"PhoneJump", {"phone-sim", "--jump", "1", "2"}, {"--jump"}},
        BadInput{"Domain", {"run", "planner", "--domain", "233"}, {"--domain", "0 to 232"}},
        BadInput{"Vehicle", {"run", "planner", "--vehicle", "u v"}, {"--vehicle", "letters"}},
        // Accepted, it would reach nobody and not say so.
        BadInput{"Network", {"run", "planner", "--network", "nonsense"}, {"--network", "nonsense"}},
        BadInput{"NetworkNotHere",
                 {"run", "planner", "--network", "192.0.2.1"},
                 {"--network", "192.0.2.1"}},
        BadInput{"AltitudeThatIsText", {"gcs", "takeoff", "high"}, {"altitude", "high"}},
        BadInput{"AltitudeThatIsNotANumber", {"gcs", "takeoff", "nan"}, {"altitude", "nan"}},
        BadInput{"PlaceThatIsText", {"gcs", "goto", "1", "north"}, {"y", "north"}},
        BadInput{"PlaceThatIsNotANumber", {"gcs", "goto", "nan", "1"}, {"x", "nan"}},
        BadInput{"PlaceThatIsInfinite", {"gcs", "goto", "1", "inf"}, {"y", "inf"}},
        BadInput{"PlaceIncomplete", {"gcs", "goto", "1"}, {"y is required"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Output, BadUsage,
    testing::Values(BadInput{"RecordingInNoFolder",
                             {"fly", hop(), "--record", "{out}/none/f.mcap", "--report",
                              "{out}/report"},
                             {"none/f.mcap: ", "cannot be created"}},
                    BadInput{"RecordingThatIsAFolder",
                             {"fly", hop(), "--record", "{in}", "--report", "{out}/report"},
                             {"{in}: ", "cannot be created"}},
                    BadInput{"ReportThatIsAFile",
                             {"fly", hop(), "--record", "{out}/f.mcap", "--report", "{in}/file"},
                             {"{in}/file: "},
                             {{"file", ""}}},
                    BadInput{"RecordWithoutAName", {"bag", "record"}, {"--output is required"}},
                    BadInput{"RecordInNoFolder",
                             {"bag", "record", "-o", "{out}/none/f.mcap"},
                             {"none/f.mcap: ", "cannot be created"}},
                    BadInput{"RecordOverAnother",
                             {"bag", "record", "-o", "{in}/f.mcap"},
                             {"{in}/f.mcap: ", "exists already"},
                             {{"f.mcap", "precious"}}},
                    BadInput{"RecordOfABadTopic",
                             {"bag", "record", "-o", "{out}/f.mcap", "sc an"},
                             {"'sc an'", "letters, digits"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    DomainId, BadUsage,
    testing::Values(domain_id("Text", "abc", {"run", "planner"}),
                    domain_id("Negative", "-1", {"run", "planner"}),
                    domain_id("TooLarge", "233", {"run", "planner"}),
                    domain_id("Fraction", "1.5", {"run", "planner"}),
                    domain_id("Huge", "99999999999999999999", {"run", "planner"}),
                    domain_id("ForFly", "abc", {"fly", hop(), "--record", "{out}/f.mcap"}),
                    domain_id("ForGcs", "abc", {"gcs", "status"}),
                    domain_id("ForRecord", "abc", {"bag", "record", "-o", "{out}/f.mcap"})),
    name_of);

}  // namespace
}  // namespace swiftlet::test
