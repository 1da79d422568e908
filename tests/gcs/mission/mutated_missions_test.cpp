// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Broken files are read, or refused with a line.
#include <regex>

#include "tests/gcs/mission/missions.hpp"

namespace swiftlet {
namespace {

/// A few bytes changed, cut out or doubled.
std::string mutated(std::string text, MissionMaker& maker) {
  constexpr char kPieces[] = "0123456789.,:-+eE[]{}\"'\n\t nulltrue#&*!%\\x\x01\xff";
  for (std::size_t i = 1 + maker.below(4); i > 0 && !text.empty(); --i) {
    const std::size_t at = maker.below(text.size());
    switch (maker.below(4)) {
      case 0:
        text[at] = kPieces[maker.below(sizeof(kPieces) - 1)];
        break;
      case 1:
        text.erase(at, 1 + maker.below(20));
        break;
      case 2:
        text.insert(at, text.substr(maker.below(text.size()), 1 + maker.below(40)));
        break;
      default:
        text.resize(at);
    }
  }
  return text;
}

TEST(MutatedMissions, AreReadOrRefusedWithALine) {
  MissionMaker maker(5);
  const std::regex begins_with_line("m:[1-9][0-9]*: (.|\n)+");
  for (const MissionForm form : {MissionForm::kYaml, MissionForm::kPlan, MissionForm::kWaypoints}) {
    std::size_t taken = 0, refused = 0;
    for (int round = 0; round < 1500; ++round) {
      const std::string whole = format_mission(form, maker.mission(false))->text;
      const auto mission = parse_mission(form, mutated(whole, maker), "m");
      mission.ok() ? ++taken : ++refused;
      if (!mission.ok()) {
        const std::string reason = mission.error().reason.substr(0, 200);
        ASSERT_TRUE(std::regex_match(reason, begins_with_line)) << reason;
        continue;
      }
      for (const WrittenItem& written : mission->items) {
        EXPECT_EQ(problem_of(written.item), "");
        EXPECT_GT(written.line, 0);
      }
    }
    EXPECT_GT(taken, 20u) << "both ways are seen";
    EXPECT_GT(refused, 200u);
  }
}

}  // namespace
}  // namespace swiftlet
