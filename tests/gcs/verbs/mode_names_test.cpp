// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/mode_names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/command_name.hpp"
#include "control/mode_machine.hpp"

namespace swiftlet {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// The verb that a mode's name means, or why there is none.
std::string meant_by(const std::string& name) {
  const auto code = command_of_mode(name);
  return code.ok() ? command_name(*code) : code.error().reason;
}

TEST(ModeNames, AsTheyAreSpelledAnywhere) {
  for (const char* name : {"Indoor Exploration", "indoor exploration", "IndoorExploration",
                           "indoor_exploration", "INDOOR-EXPLORATION", "explore", "exploration"}) {
    EXPECT_EQ(meant_by(name), "explore") << name;
  }
  for (const char* name : {"Assisted Manual", "assist", "assisted", "assisted-manual"}) {
    EXPECT_EQ(meant_by(name), "assist") << name;
  }
  EXPECT_EQ(meant_by("Takeoff"), "takeoff");
  EXPECT_EQ(meant_by("take-off"), "takeoff");
  EXPECT_EQ(meant_by("Hover"), "hover");
  EXPECT_EQ(meant_by("Land"), "land");
  EXPECT_EQ(meant_by("manual"), "manual");
  EXPECT_EQ(meant_by("return"), "return");
}

TEST(ModeNames, EveryModeButGroundedIsKnownByTheNameThatItIsShownWith) {
  for (const Mode mode : kModes) {
    if (mode == Mode::kGrounded) continue;
    EXPECT_THAT(meant_by(to_string(mode)), Not(HasSubstr("there is no mode"))) << to_string(mode);
  }
}

TEST(ModeNames, EachWordThatIsOfferedIsTheVerbOfItsMode) {
  EXPECT_EQ(mode_words().size(), 7u);
  for (const std::string& word : mode_words()) EXPECT_EQ(meant_by(word), word);
}

TEST(ModeNames, ThoseThatNeedAPlaceNameTheVerbThatTakesIt) {
  EXPECT_THAT(meant_by("GPS Guidance"), HasSubstr("swiftlet gcs gps LATITUDE LONGITUDE"));
  EXPECT_THAT(meant_by("gps"), HasSubstr("swiftlet gcs gps"));
  EXPECT_THAT(meant_by("Indoor Navigation"), HasSubstr("swiftlet gcs goto X Y [Z]"));
}

TEST(ModeNames, AnUnknownOneListsTheEight) {
  const std::string reason = meant_by("Hovr");
  EXPECT_THAT(reason, HasSubstr("there is no mode 'Hovr'; did you mean 'Hover'?"));
  for (const Mode mode : kModes) {
    if (mode == Mode::kGrounded) continue;
    EXPECT_THAT(reason, HasSubstr(to_string(mode)));
  }
  EXPECT_THAT(reason, Not(HasSubstr("Grounded")));
  EXPECT_THAT(meant_by(""), HasSubstr("there is no mode ''"));
  EXPECT_THAT(meant_by("xylophone"), Not(HasSubstr("did you mean")));
}

}  // namespace
}  // namespace swiftlet
