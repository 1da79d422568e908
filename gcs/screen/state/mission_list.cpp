// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/state/mission_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace swiftlet::screen {
namespace {

using Kind = MissionItem::Kind;

WrittenItem waypoint_at(const Eigen::Vector3d& place) {
  WrittenItem written;
  written.item.place.position = place;
  return written;
}

std::optional<double> height_of(const MissionItem& item) {
  if (item.kind == Kind::kTakeoff) return item.altitude;
  if (item.kind != Kind::kWaypoint) return std::nullopt;
  return item.global ? item.global->altitude : item.place.position.z();
}

bool is_in_map(const MissionItem& item) {
  return item.kind == Kind::kWaypoint && !item.global;
}

}  // namespace

std::optional<Eigen::Vector2d> place_in_map(const MissionItem& item,
                                            const std::optional<LocalOrigin>& origin) {
  if (is_in_map(item)) return Eigen::Vector2d(item.place.position.head<2>());
  if (item.kind != Kind::kWaypoint || !origin) return std::nullopt;
  constexpr double kAnyHeight = 1.0;  // it does not count from above
  const auto place = place_of(*item.global, *origin, kAnyHeight, 0.0);
  return place.ok() ? std::optional<Eigen::Vector2d>(place->head<2>()) : std::nullopt;
}

const MissionItem* MissionList::current() const {
  return empty() ? nullptr : &mission_.items[static_cast<std::size_t>(selected_)].item;
}

MissionItem* MissionList::edited() {
  if (empty()) return nullptr;
  ++revision_;
  return &mission_.items[static_cast<std::size_t>(selected_)].item;
}

void MissionList::select(int index) {
  selected_ = std::clamp(index, 0, std::max(0, static_cast<int>(size()) - 1));
}

bool MissionList::is_ended() const {
  if (empty()) return false;
  const Kind last = items().back().item.kind;
  return last == Kind::kReturn || last == Kind::kLand;
}

void MissionList::append(WrittenItem written) {
  ++revision_;
  const auto at = static_cast<std::ptrdiff_t>(size()) - (is_ended() ? 1 : 0);
  mission_.items.insert(mission_.items.begin() + at, std::move(written));
  select(static_cast<int>(at));
}

void MissionList::append(const Eigen::Vector3d& place) {
  append(waypoint_at(place));
}

void MissionList::append_global(const GlobalWaypoint& place) {
  WrittenItem written;
  written.item.global = place;
  append(std::move(written));
}

void MissionList::put_takeoff(double altitude) {
  if (!empty() && items().front().item.kind == Kind::kTakeoff) return select(0);
  ++revision_;
  WrittenItem takeoff;
  takeoff.item.kind = Kind::kTakeoff;
  takeoff.item.altitude = altitude;
  mission_.items.insert(mission_.items.begin(), takeoff);
  select(0);
}

void MissionList::put_end(Kind kind) {
  ++revision_;
  if (is_ended()) mission_.items.pop_back();
  WrittenItem end;
  end.item.kind = kind;
  mission_.items.push_back(end);
  select(static_cast<int>(size()));
}

void MissionList::insert(const Eigen::Vector3d& place) {
  ++revision_;
  mission_.items.insert(mission_.items.begin() + selected_, waypoint_at(place));
}

Status MissionList::move_to(const Eigen::Vector2d& place,
                            const std::optional<LocalOrigin>& origin) {
  if (empty()) return {};
  if (current()->kind != Kind::kWaypoint) {
    return Error{fmt::format("item {} has no place", selected_ + 1)};
  }
  if (!current()->global) {
    edited()->place.position.head<2>() = place;
    return {};
  }
  if (!origin) {
    return Error{
        fmt::format("item {} is on Earth, and nobody says where the map is there; is "
                    "there a GPS fix?",
                    selected_ + 1)};
  }
  const GlobalPosition there = origin->to_global({place.x(), place.y(), 0.0});
  GlobalWaypoint& waypoint = *edited()->global;
  waypoint.latitude = there.latitude;
  waypoint.longitude = there.longitude;
  return {};
}

std::optional<double> MissionList::height() const {
  return empty() ? std::nullopt : height_of(*current());
}

void MissionList::set_height(double height) {
  if (!this->height()) return;
  MissionItem& item = *edited();
  if (item.kind == Kind::kTakeoff) {
    item.altitude = height;
  } else if (item.global) {
    item.global->altitude = height;
  } else {
    item.place.position.z() = height;
  }
}

std::optional<double> MissionList::height_nearby() const {
  const auto begin = items().begin(), end = items().end();
  if (begin == end) return std::nullopt;
  const auto behind = begin + selected_ + 1;
  const auto fits = [](const WrittenItem& written) { return is_in_map(written.item); };
  const auto before = std::find_if(std::make_reverse_iterator(behind), items().rend(), fits);
  if (before != items().rend()) return before->item.place.position.z();
  const auto after = std::find_if(behind, end, fits);
  return after == end ? std::nullopt : std::optional(after->item.place.position.z());
}

void MissionList::remove() {
  if (empty()) return;
  ++revision_;
  mission_.items.erase(mission_.items.begin() + selected_);
  select(selected_);
}

void MissionList::replace(MissionFile mission) {
  ++revision_;
  mission_ = std::move(mission);
  selected_ = 0;
  file_.clear();
}

void MissionList::swap_with(int other) {
  if (other < 0 || other >= static_cast<int>(size())) return;
  ++revision_;
  std::swap(mission_.items[static_cast<std::size_t>(selected_)],
            mission_.items[static_cast<std::size_t>(other)]);
  selected_ = other;
}

void MissionList::set_kept(const std::string& file) {
  kept_ = revision_;
  file_ = file;
}

}  // namespace swiftlet::screen
