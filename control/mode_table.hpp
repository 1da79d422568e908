// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace swiftlet {

enum class Mode {
  kGrounded,
  kTakeoff,
  kHover,
  kLand,
  kManual,
  kAssistedManual,
  kGpsGuidance,
  kIndoorNavigation,
  kIndoorExploration
};
inline constexpr std::array kModes{
    Mode::kGrounded,    Mode::kTakeoff,          Mode::kHover,
    Mode::kLand,        Mode::kManual,           Mode::kAssistedManual,
    Mode::kGpsGuidance, Mode::kIndoorNavigation, Mode::kIndoorExploration};
/// As a pilot reads it: "Indoor Navigation".
const char* to_string(Mode mode);

/// What a pilot or the commander asks for.
struct Request {
  enum class Kind {
    kArm,
    kDisarm,
    kTakeoff,
    kHover,
    kLand,
    kManual,
    kAssist,
    kGps,
    kNavigate,
    kExplore,
    kReturn
  };
  Kind kind = Kind::kHover;
  double altitude = 0.0;        ///< takeoff: above the take-off point [m]
  std::uint64_t mission = 0;    ///< gps, navigate: identity of the mission, its checksum
  std::string mission_problem;  ///< gps to return: why it cannot be flown; empty if it can

  static Request arm() { return {Kind::kArm, 0.0, 0, {}}; }
  static Request disarm() { return {Kind::kDisarm, 0.0, 0, {}}; }
  static Request takeoff(double altitude) { return {Kind::kTakeoff, altitude, 0, {}}; }
  static Request hover() { return {Kind::kHover, 0.0, 0, {}}; }
  static Request land() { return {Kind::kLand, 0.0, 0, {}}; }
  static Request manual() { return {Kind::kManual, 0.0, 0, {}}; }
  static Request assist() { return {Kind::kAssist, 0.0, 0, {}}; }
  static Request gps(std::uint64_t mission, std::string problem = {}) {
    return {Kind::kGps, 0.0, mission, std::move(problem)};
  }
  static Request navigate(std::uint64_t mission, std::string problem = {}) {
    return {Kind::kNavigate, 0.0, mission, std::move(problem)};
  }
  static Request explore(std::string problem = {}) {
    return {Kind::kExplore, 0.0, 0, std::move(problem)};
  }
  static Request go_back(std::string problem = {}) {
    return {Kind::kReturn, 0.0, 0, std::move(problem)};
  }
};
inline constexpr std::array kRequestKinds{
    Request::Kind::kArm,     Request::Kind::kDisarm, Request::Kind::kTakeoff,
    Request::Kind::kHover,   Request::Kind::kLand,   Request::Kind::kManual,
    Request::Kind::kAssist,  Request::Kind::kGps,    Request::Kind::kNavigate,
    Request::Kind::kExplore, Request::Kind::kReturn};
const char* to_string(Request::Kind kind);

/// What each mode answers to each request, in one table (control/README.md).
struct RequestRule {
  enum class Answer { kGo, kAlready, kRefuse };
  Mode mode;
  bool armed;
  Request::Kind request;
  Answer answer;
  Mode to;             ///< kGo
  const char* reason;  ///< kRefuse: what is wrong and what to do; kAlready: what is so already
};
RequestRule request_rule(Mode mode, bool armed, Request::Kind request);

/// What happens by itself, in order of precedence.
struct EventRule {
  enum class Event {
    kLanded,
    kEstimateLost,
    kLandDemanded,
    kReturnDemanded,
    kHoverDemanded,
    kTakeoffFailed,
    kReferenceFinished,
    kReturnFailed,
    kReturned,
    kNavigationFailed,
    kNavigationFinished,
    kSticksSilent,
    kObstaclesUnseen
  };
  Event event;
  Mode from;
  Mode to;
};
const char* to_string(EventRule::Event event);
const std::vector<EventRule>& event_rules();

}  // namespace swiftlet
