// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The keyboard on which a mission is put together.
#include <fmt/format.h>

#include "gcs/screen/state/controller.hpp"

namespace swiftlet::screen {
namespace {

using Kind = Action::Kind;

std::string text_of(const MissionFinding& finding) {
  return finding.item > 0 ? fmt::format("item {}: {}", finding.item, finding.text)
                          : "mission: " + finding.text;
}

bool is_error(const MissionFinding& finding) {
  return finding.severity == MissionFinding::Severity::kError;
}

}  // namespace

std::vector<Action> Controller::edit_waypoints(Deed deed, const Circumstances& circumstances) {
  if (look(deed)) return {};
  map_.move_cursor(deed);
  switch (deed) {
    case Deed::kHover:
      return hover(circumstances);
    case Deed::kGoOn:
      return go_on(circumstances);
    case Deed::kMove: {
      const Status moved = waypoints_.move_to(*cursor(), circumstances.check.origin);
      if (moved.ok()) return {};
      return {message(Kind::kTell, Severity::kCaution, moved.error().reason)};
    }
    case Deed::kStart:
      return start(circumstances);
    case Deed::kSave:
      if (!waypoints_.empty()) write(deed, "Write which file?", file_);
      return {};
    case Deed::kLoad:
      write(deed, "Open which file?", file_);
      return {};
    case Deed::kFetchMission:
      return replace_list(action(Kind::kFetchMission));
    case Deed::kClearMission:
      ask("Clear the vehicle's mission?", action(Kind::kClearMission));
      return {};
    case Deed::kLeave:
      end_cursor();
      return {};
    default:
      edit_items(deed, circumstances);
      return {};
  }
}

void Controller::edit_items(Deed deed, const Circumstances& circumstances) {
  switch (deed) {
    case Deed::kAppend:
      return waypoints_.append(place(circumstances));
    case Deed::kInsert:
      return waypoints_.insert(place(circumstances));
    case Deed::kAppendGlobal:
      return ask_for_global(deed);
    case Deed::kAppendTakeoff:
      return waypoints_.put_takeoff(kUsualAltitude);
    case Deed::kAppendReturn:
      return waypoints_.put_end(MissionItem::Kind::kReturn);
    case Deed::kAppendLanding:
      return waypoints_.put_end(MissionItem::Kind::kLand);
    case Deed::kHeight:
      if (!waypoints_.height()) return;
      return write(deed, fmt::format("Height of item {} [m]", waypoints_.selected() + 1),
                   fmt::format("{:g}", *waypoints_.height()));
    case Deed::kRemove:
      return waypoints_.remove();
    case Deed::kClear:
      if (waypoints_.empty()) return;
      ask(fmt::format("Remove all {} items of the list?", waypoints_.size()), {});
      asked_.reset();
      return;
    case Deed::kNext:
      return waypoints_.select_next();
    case Deed::kPrevious:
      return waypoints_.select_previous();
    case Deed::kEarlier:
      return waypoints_.earlier();
    case Deed::kLater:
      return waypoints_.later();
    default:
      return;
  }
}

/// What cannot be flown is not sent, and stays to be put right.
std::vector<Action> Controller::start(const Circumstances& circumstances) {
  if (waypoints_.empty()) {
    return {
        message(Kind::kTell, Severity::kCaution, "not sent: the list is empty; a adds an item")};
  }
  MissionCheckParams params = circumstances.check;
  const OccupancyGrid map = circumstances.map ? known_map(*circumstances.map) : OccupancyGrid();
  params.map = &map;
  const MissionCheck check = check_mission(waypoints_.mission(), params);
  Actions actions;
  const MissionFinding* first = nullptr;
  for (const MissionFinding& finding : check.findings) {
    if (first == nullptr && is_error(finding)) {
      first = &finding;
      continue;
    }
    const Severity severity = is_error(finding) ? Severity::kDanger : Severity::kCaution;
    actions.push_back(message(Kind::kNote, severity, text_of(finding)));
  }
  if (first != nullptr) {
    if (first->item > 0) waypoints_.select(static_cast<int>(first->item) - 1);
    actions.push_back(message(Kind::kTell, Severity::kDanger, "not sent: " + text_of(*first)));
    return actions;
  }
  actions.push_back(action(Kind::kFlyMission));
  actions.back().mission = waypoints_.mission();
  end_cursor();
  return actions;
}

std::vector<Action> Controller::replace_list(Action action) {
  if (waypoints_.is_kept()) return {action};
  ask(fmt::format("The list of {} is not saved. Replace it?", waypoints_.size()),
      std::move(action));
  return {};
}

std::vector<Action> Controller::accept_file(Deed about) {
  if (text_.empty()) return {};  // it has no name yet
  close();
  file_ = text_;
  Action use = action(about == Deed::kSave ? Kind::kSave : Kind::kLoad);
  use.file = text_;
  if (about == Deed::kLoad) return replace_list(use);
  use.replaces = use.file == waypoints_.file();
  return {use};
}

}  // namespace swiftlet::screen
