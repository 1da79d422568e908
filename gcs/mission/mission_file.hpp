// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "control/mission.hpp"
#include "estimation/basics/result.hpp"
#include "estimation/geodesy/local_origin.hpp"

namespace swiftlet {

/// What a reader or a writer of a file does otherwise than it says, in a sentence.
struct MissionRemark {
  int line = 0;  ///< of the file that was read, from 1; 0 where it is about none
  std::string text;
};

/// An item, and where it was written.
struct WrittenItem {
  MissionItem item;
  int line = 0;  ///< from 1; 0 where it comes from no file
};

/// An area on Earth to stay in, or to stay out of: a circle, or a polygon where it has corners.
struct FenceZone {
  bool stay_inside = true;
  GlobalPosition centre;  ///< of a circle
  double radius = 0.0;    ///< of a circle [m]
  std::vector<GlobalPosition> corners;
  int line = 0;
};

/// A whole mission as a person wrote it, in whichever form. Whatever was read is finite, and each
/// of its items makes sense (problem_of).
struct MissionFile {
  std::string name;  ///< "" where it has none
  std::vector<WrittenItem> items;
  std::vector<MissionRemark> remarks;  ///< by line
  /// What time is reckoned with where a waypoint on Earth has no speed of its own [m/s]. The
  /// vehicle is not told: it has a usual speed.
  std::optional<double> cruise_speed;
  /// Where it is planned to take off, with the altitude above sea as the file has it.
  std::optional<GlobalPosition> home;
  /// Stay in any of those to stay inside of, and out of all others. The vehicle is not told.
  std::vector<FenceZone> fence;
};

std::vector<MissionItem> items_of(const MissionFile& mission);

/// One for all that say the same, at the first of their lines: a survey has hundreds.
std::vector<MissionRemark> merged(const std::vector<MissionRemark>& remarks);

/// By what a name ends with.
enum class MissionForm {
  kYaml,       ///< ours: .yaml
  kPlan,       ///< of QGroundControl: .plan
  kWaypoints,  ///< of Mission Planner and MAVLink's tools: .waypoints
};
Result<MissionForm> mission_form_of(const std::filesystem::path& file);

struct MissionReading {
  /// Of the take-off point above sea, for files that say altitudes above sea and no home [m].
  std::optional<double> home_altitude;
};

/// "file:12: what is wrong, and what to do" where it cannot be used.
Result<MissionFile> read_mission(const std::filesystem::path& file,
                                 const MissionReading& reading = {});
/// The same from a text; `name` stands for the file in errors.
Result<MissionFile> parse_mission(MissionForm form, const std::string& text,
                                  const std::string& name, const MissionReading& reading = {});

struct MissionText {
  std::string text;
  std::vector<MissionRemark> losses;  ///< what the form cannot say
};

/// An error where the form cannot hold it: a waypoint in the map is no place on Earth.
Result<MissionText> format_mission(MissionForm form, const MissionFile& mission);
/// Writes it, whole or not at all, and returns what the form cannot say.
Result<std::vector<MissionRemark>> write_mission(const std::filesystem::path& file,
                                                 const MissionFile& mission);

}  // namespace swiftlet
