// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// A mission file: in each form, what is read is flyable, can be checked, and is the same when it is
// written and read again.
#include <cmath>

#include "gcs/mission/mission_check.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace swiftlet;

void check_again(MissionForm form, const MissionFile& mission) {
  const auto text = format_mission(form, mission);
  if (!text.ok()) return;  // a form may not hold it
  const auto again = parse_mission(form, text->text, "again");
  fuzz::demand(again.ok(), "what was written can be read",
               again.ok() ? "" : again.error().reason + "\n" + text->text);
  fuzz::demand(again->items.size() == mission.items.size(), "with as many items", text->text);
  for (std::size_t i = 0; i < mission.items.size(); ++i) {
    const MissionItem &a = again->items[i].item, &b = mission.items[i].item;
    fuzz::demand(a.kind == b.kind && a.hold == b.hold, "of the same kinds", text->text);
  }
}

void read_as(MissionForm form, const std::string& text) {
  const auto mission = parse_mission(form, text, "fuzz");
  if (!mission.ok()) {
    fuzz::demand(mission.error().reason.compare(0, 5, "fuzz:") == 0, "an error has a line",
                 mission.error().reason);
    return;
  }
  for (const WrittenItem& written : mission->items) {
    fuzz::demand(problem_of(written.item).empty(), "what was read can be flown");
    fuzz::demand(written.line > 0, "an item has a line");
  }
  MissionCheckParams params;
  params.fence = {100.0, 100.0};
  params.endurance = 600.0;
  const MissionCheck check = check_mission(*mission, params);
  fuzz::demand(std::isfinite(check.duration), "a mission has a duration");
  for (const MissionForm other :
       {MissionForm::kYaml, MissionForm::kPlan, MissionForm::kWaypoints}) {
    check_again(other, *mission);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = fuzz::text_of(data, size);
  for (const MissionForm form : {MissionForm::kYaml, MissionForm::kPlan, MissionForm::kWaypoints}) {
    read_as(form, text);
  }
  return 0;
}
