// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/mission/mission_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>

#include "components/runtime/config/config.hpp"
#include "estimation/basics/whole_file.hpp"
#include "gcs/mission/line_problem.hpp"
#include "gcs/mission/plan_form.hpp"
#include "gcs/mission/waypoints_form.hpp"
#include "gcs/mission/yaml_form.hpp"

namespace swiftlet {
namespace {

/// A survey of a thousand lines with a photo every metre has less.
constexpr std::size_t kMostBytes = 8 << 20;
// More than any vehicle flies, and few enough to look at each with each.
constexpr std::size_t kMostItems = 10'000;
constexpr std::size_t kMostCorners = 1'000;

MissionFile parse(MissionForm form, const std::string& text, const std::string& name,
                  const MissionReading& reading) {
  switch (form) {
    case MissionForm::kYaml:
      return parse_yaml_mission(text, name);
    case MissionForm::kPlan:
      return parse_plan(text, reading);
    case MissionForm::kWaypoints:
      return parse_waypoints(text, reading);
  }
  throw LineProblem(1, "there is no such form");
}

/// What every form demands.
void check(const MissionFile& mission) {
  if (mission.items.empty()) {
    throw LineProblem(1, "there are no items that can be flown; add at least one");
  }
  if (mission.items.size() > kMostItems) {
    throw LineProblem(mission.items[kMostItems].line,
                      fmt::format("more than {} items; make several missions of it", kMostItems));
  }
  std::size_t corners = 0;
  for (const FenceZone& zone : mission.fence) {
    corners += 1 + zone.corners.size();
    if (corners <= kMostCorners) continue;
    throw LineProblem(zone.line, fmt::format("a fence of more than {} areas and corners; make it "
                                             "simpler",
                                             kMostCorners));
  }
  for (std::size_t i = 0; i < mission.items.size(); ++i) {
    const std::string problem = problem_of(mission.items[i].item);
    if (problem.empty()) continue;
    throw LineProblem(mission.items[i].line,
                      fmt::format("item {}: {}; correct it, or leave it out", i + 1, problem));
  }
}

}  // namespace

std::vector<MissionItem> items_of(const MissionFile& mission) {
  std::vector<MissionItem> items;
  for (const WrittenItem& written : mission.items) items.push_back(written.item);
  return items;
}

std::vector<MissionRemark> merged(const std::vector<MissionRemark>& remarks) {
  std::map<std::string, std::size_t> counts;
  for (const MissionRemark& remark : remarks) ++counts[remark.text];
  std::vector<MissionRemark> merged;
  for (const MissionRemark& remark : remarks) {
    const auto counted = counts.find(remark.text);
    if (counted == counts.end()) continue;
    merged.push_back(remark);
    if (counted->second > 1) {
      merged.back().text += fmt::format(" (and {} more like it)", counted->second - 1);
    }
    counts.erase(counted);
  }
  return merged;
}

Result<MissionForm> mission_form_of(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  if (ending == ".yaml" || ending == ".yml") return MissionForm::kYaml;
  if (ending == ".plan") return MissionForm::kPlan;
  if (ending == ".waypoints") return MissionForm::kWaypoints;
  return Error{fmt::format("{}: a mission file ends in .yaml, .plan or .waypoints; rename it",
                           file.string())};
}

Result<MissionFile> parse_mission(MissionForm form, const std::string& text,
                                  const std::string& name, const MissionReading& reading) {
  try {
    if (text.size() > kMostBytes) {
      throw LineProblem(1, fmt::format("has {} bytes; a mission has at most {}; is it one?",
                                       text.size(), kMostBytes));
    }
    MissionFile mission = parse(form, text, name, reading);
    check(mission);
    std::stable_sort(
        mission.remarks.begin(), mission.remarks.end(),
        [](const MissionRemark& a, const MissionRemark& b) { return a.line < b.line; });
    return mission;
  } catch (const LineProblem& problem) {
    return Error{fmt::format("{}:{}: {}", name, problem.line(), problem.what())};
  } catch (const ConfigError& error) {
    return Error{error.what()};
  }
}

Result<MissionFile> read_mission(const std::filesystem::path& file, const MissionReading& reading) {
  const Result<MissionForm> form = mission_form_of(file);
  if (!form.ok()) return form.error();
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file)) {
    return Error{
        fmt::format("{}: cannot be read; check the path and its permissions", file.string())};
  }
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return parse_mission(*form, text, file.string(), reading);
}

Result<MissionText> format_mission(MissionForm form, const MissionFile& mission) {
  switch (form) {
    case MissionForm::kYaml:
      return MissionText{format_yaml_mission(mission), {}};
    case MissionForm::kPlan:
      return format_plan(mission);
    case MissionForm::kWaypoints:
      return format_waypoints(mission);
  }
  return Error{"there is no such form"};
}

Result<std::vector<MissionRemark>> write_mission(const std::filesystem::path& file,
                                                 const MissionFile& mission) {
  const Result<MissionForm> form = mission_form_of(file);
  if (!form.ok()) return form.error();
  Result<MissionText> text = format_mission(*form, mission);
  if (!text.ok()) return Error{fmt::format("{}: {}", file.string(), text.error().reason)};
  const Status written = write_whole(file, text->text);
  if (!written.ok()) return written.error();
  return std::move(text->losses);
}

}  // namespace swiftlet
