// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Missions between the list, the vehicle and files.
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "gcs/screen/shell/screen_component.hpp"

namespace swiftlet::screen {

void ScreenComponent::bring(const Action& action, Time now) {
  if (errand_.busy() || sender_.busy()) {
    const std::string other = errand_.busy() ? "another transfer" : sender_.name();
    return tell(Severity::kCaution, fmt::format("upload: wait, {} is under way", other));
  }
  errand_.bring(fmt::format("gcs-{}-{}", getpid(), now.time_since_epoch().count()), action.mission,
                now);
}

void ScreenComponent::fetch(Time now) {
  if (errand_.busy()) {
    return tell(Severity::kCaution, "download: wait, another transfer is under way");
  }
  fetched_over_ = controller_.waypoints().revision();
  errand_.fetch(now);
}

void ScreenComponent::carry_mission(Time now) {
  const bool brings = errand_.brings();
  MissionErrand::Step step = errand_.advance(now);
  for (auto& part : step.outgoing.parts) {
    part.station(station_);
    mission_parts_.publish(part);
  }
  if (step.outgoing.fetch) mission_fetch_.publish(*step.outgoing.fetch);
  if (!step.progress.empty()) model_.set_command({step.progress, Severity::kCaution});
  if (!step.outcome) return;
  tell(step.outcome->ok ? Severity::kSuccess : Severity::kDanger, step.outcome->text);
  if (!step.outcome->ok) return;
  if (brings) return begin(action(Action::Kind::kFlyMission), now);
  put_into_list(std::move(*step.outcome->fetched));
}

void ScreenComponent::put_into_list(MissionFile mission) {
  MissionList& list = controller_.waypoints();
  const Keyboard keyboard = controller_.keyboard();
  const bool is_asked = keyboard == Keyboard::kText || keyboard == Keyboard::kConfirm;
  if (is_asked || list.revision() != fetched_over_) {
    return tell(Severity::kCaution, "download: the list is being edited, and is kept");
  }
  list.replace(std::move(mission));
  list.set_kept("");
}

void ScreenComponent::save(const Action& action) {
  const std::string& file = action.file;
  std::error_code ignored;  // what cannot be looked at cannot be written either
  if (!action.replaces && mission_form_of(file).ok() && std::filesystem::exists(file, ignored)) {
    Action again = action;
    again.replaces = true;
    return controller_.ask(file + " exists. Replace it?", again);
  }
  MissionList& list = controller_.waypoints();
  const auto written = write_mission(file, list.mission());
  if (!written.ok()) return tell(Severity::kDanger, written.error().reason);
  note(file, *written);
  list.set_kept(file);
  tell(Severity::kSuccess, fmt::format("{} items written to {}", list.size(), file));
}

void ScreenComponent::load(const Action& action) {
  Result<MissionFile> mission = read_mission(action.file);
  if (!mission.ok()) return tell(Severity::kDanger, mission.error().reason);
  const std::size_t remarks = note(action.file, mission->remarks);
  MissionList& list = controller_.waypoints();
  list.replace(std::move(*mission));
  list.set_kept(action.file);
  const std::size_t count = list.size();
  if (remarks == 0) {
    return tell(Severity::kSuccess, fmt::format("{} items read from {}", count, action.file));
  }
  tell(Severity::kCaution,
       fmt::format("{} items, {} remarks (see events): {}", count, remarks, action.file));
}

std::size_t ScreenComponent::note(const std::string& file,
                                  const std::vector<MissionRemark>& remarks) {
  const std::vector<MissionRemark> different = merged(remarks);
  for (const MissionRemark& remark : different) {
    const std::string where = remark.line > 0 ? fmt::format("{}:{}", file, remark.line) : file;
    model_.note(now(), Severity::kCaution, where + ": " + remark.text);
  }
  return different.size();
}

}  // namespace swiftlet::screen
