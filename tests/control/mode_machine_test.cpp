// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/mode_machine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <vector>

namespace swiftlet {
namespace {

using ::testing::HasSubstr;
using Kind = Request::Kind;
using Navigation = Situation::Navigation;

constexpr std::uint64_t kMission = 42;

Situation flying() {
  Situation s;
  s.now = Time(std::chrono::seconds(10));
  s.ready = true;
  s.estimate_ok = true;
  s.on_ground = false;
  s.height = 1.2;
  s.navigation = Navigation::kActive;
  return s;
}

Situation grounded() {
  Situation s = flying();
  s.on_ground = true;
  s.height = 0.0;
  s.navigation = Navigation::kInactive;
  return s;
}

Request ordinary(Kind kind) {
  switch (kind) {
    case Kind::kTakeoff:
      return Request::takeoff(1.2);
    case Kind::kGps:
      return Request::gps(kMission);
    case Kind::kNavigate:
      return Request::navigate(kMission);
    default:
      return Request{kind, 0.0, 0, {}};
  }
}

/// A machine that was brought to a mode through requests and events alone.
ModeMachine in(Mode mode, bool armed = true) {
  ModeMachine machine;
  if (mode == Mode::kGrounded && !armed) return machine;
  EXPECT_TRUE(machine.request(Request::arm(), grounded()).ok());
  if (mode == Mode::kGrounded) return machine;
  EXPECT_TRUE(machine.request(Request::takeoff(1.2), grounded()).ok());
  if (mode == Mode::kTakeoff) return machine;
  Situation top = flying();
  top.reference_finished = true;
  EXPECT_TRUE(machine.update(top).has_value());
  if (mode == Mode::kLand) {
    EXPECT_TRUE(machine.request(Request::land(), flying()).ok());
  }
  if (mode == Mode::kManual) {
    EXPECT_TRUE(machine.request(Request::manual(), flying()).ok());
  }
  if (mode == Mode::kAssistedManual) {
    EXPECT_TRUE(machine.request(Request::assist(), flying()).ok());
  }
  if (mode == Mode::kGpsGuidance) {
    EXPECT_TRUE(machine.request(Request::gps(kMission), flying()).ok());
  }
  if (mode == Mode::kIndoorNavigation) {
    EXPECT_TRUE(machine.request(Request::navigate(kMission), flying()).ok());
  }
  if (mode == Mode::kIndoorExploration) {
    EXPECT_TRUE(machine.request(Request::explore(), flying()).ok());
  }
  EXPECT_EQ(machine.mode(), mode);
  return machine;
}

struct Row {
  Mode mode;
  bool armed;
  // The mode afterwards, in the order arm, disarm, takeoff, hover, land, manual, assist, gps,
  // navigate, explore, return; "=" accepted and nothing changes, "-" refused.
  std::vector<std::string> answers;
};

// clang-format off
const std::string kM = "Manual", kA = "Assisted Manual", kG = "GPS Guidance", kN = "Indoor Navigation",
                  kE = "Indoor Exploration";
const std::vector<Row> kExpected{
    {Mode::kGrounded, false, {"Grounded", "=", "-", "-", "=", "-", "-", "-", "-", "-", "-"}},
    {Mode::kGrounded, true, {"=", "Grounded", "Takeoff", "-", "=", "-", "-", "-", "-", "-", "-"}},
    {Mode::kTakeoff, true, {"=", "-", "=", "Hover", "Land", kM, kA, "-", "-", "-", "-"}},
    {Mode::kHover, true, {"=", "-", "=", "=", "Land", kM, kA, kG, kN, kE, kN}},
    {Mode::kLand, true, {"=", "-", "-", "Hover", "=", kM, kA, "-", "-", "-", "-"}},
    {Mode::kManual, true, {"=", "-", "=", "Hover", "Land", "=", kA, kG, kN, kE, kN}},
    {Mode::kAssistedManual, true, {"=", "-", "=", "Hover", "Land", kM, "=", kG, kN, kE, kN}},
    {Mode::kGpsGuidance, true, {"=", "-", "=", "Hover", "Land", kM, kA, "=", kN, kE, kG}},
    {Mode::kIndoorNavigation, true, {"=", "-", "=", "Hover", "Land", kM, kA, kG, "=", kE, kN}},
    {Mode::kIndoorExploration, true, {"=", "-", "=", "Hover", "Land", kM, kA, kG, kN, "=", kN}},
};
// clang-format on

TEST(ModeMachineRequests, EveryPairOfModeAndRequestAnswersAsTheTable) {
  for (const Row& row : kExpected) {
    for (std::size_t i = 0; i < kRequestKinds.size(); ++i) {
      const std::string pair = std::string(to_string(row.mode)) + (row.armed ? "" : " disarmed") +
                               " / " + to_string(kRequestKinds[i]);
      ModeMachine machine = in(row.mode, row.armed);
      const bool was_armed = machine.armed();
      const Situation situation = row.mode == Mode::kGrounded ? grounded() : flying();
      const auto result = machine.request(ordinary(kRequestKinds[i]), situation);
      const std::string& expected = row.answers[i];
      if (expected == "-") {
        ASSERT_FALSE(result.ok()) << pair;
        EXPECT_THAT(result.error().reason,
                    HasSubstr(std::string(to_string(kRequestKinds[i])) + " refused: "));
        EXPECT_GT(result.error().reason.size(), 25u)
            << "a reason that helps: " << result.error().reason;
      } else {
        ASSERT_TRUE(result.ok()) << pair;
        EXPECT_EQ(*result, expected == "=" ? Acceptance::kUnchanged : Acceptance::kChanged) << pair;
      }
      const bool stays = expected == "-" || expected == "=";
      EXPECT_STREQ(to_string(machine.mode()), stays ? to_string(row.mode) : expected.c_str())
          << pair;
      bool armed = was_armed;
      if (!stays && kRequestKinds[i] == Kind::kArm) armed = true;
      if (!stays && kRequestKinds[i] == Kind::kDisarm) armed = false;
      EXPECT_EQ(machine.armed(), armed) << pair;
    }
  }
}

TEST(ModeMachineRequests, AskedTwiceTheyChangeNothingTheSecondTime) {
  for (const Row& row : kExpected) {
    for (const Kind kind : kRequestKinds) {
      ModeMachine machine = in(row.mode, row.armed);
      const Situation situation = row.mode == Mode::kGrounded ? grounded() : flying();
      const auto first = machine.request(ordinary(kind), situation);
      const Mode mode = machine.mode();
      const auto second = machine.request(ordinary(kind), situation);
      EXPECT_EQ(machine.mode(), mode);
      ASSERT_EQ(second.ok(), first.ok()) << to_string(row.mode) << " / " << to_string(kind);
      if (first.ok()) {
        EXPECT_EQ(*second, Acceptance::kUnchanged);
      }
    }
  }
}

TEST(ModeMachineRequests, ATakeoffToAnotherAltitudeIsAnotherRequest) {
  for (const Mode mode : kModes) {
    if (mode == Mode::kGrounded || mode == Mode::kLand) continue;
    ModeMachine machine = in(mode);
    const auto result = machine.request(Request::takeoff(2.0), flying());
    ASSERT_FALSE(result.ok());
    EXPECT_THAT(result.error().reason,
                HasSubstr(mode == Mode::kTakeoff ? "taking off already, to 1.20 m"
                                                 : "in the air already, at 1.20 m"));
    EXPECT_EQ(machine.takeoff_altitude(), 1.2);
  }
}

TEST(ModeMachineRequests, ATakeoffIsNotDoneBecauseItWasOnce) {
  ModeMachine machine = in(Mode::kHover);
  Situation elsewhere = flying();
  elsewhere.height = 0.4;
  const auto result = machine.request(Request::takeoff(1.2), elsewhere);
  ASSERT_FALSE(result.ok());
  EXPECT_THAT(result.error().reason, HasSubstr("in the air already, at 0.40 m; goto X Y Z"));
  // Whoever is still climbing gets there.
  machine = in(Mode::kTakeoff);
  EXPECT_TRUE(machine.request(Request::takeoff(1.2), elsewhere).ok());
}

TEST(ModeMachineRequests, AnotherMissionReplacesTheOneThatIsFlown) {
  ModeMachine machine = in(Mode::kIndoorNavigation);
  const auto result = machine.request(Request::navigate(kMission + 1), flying());
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(*result, Acceptance::kChanged);
  EXPECT_EQ(machine.mission(), kMission + 1);
}

TEST(ModeMachineRequests, RefusalsNameTheCulprit) {
  const auto reason = [](ModeMachine machine, const Request& request, const Situation& situation) {
    const Mode before = machine.mode();
    const auto result = machine.request(request, situation);
    EXPECT_FALSE(result.ok());
    EXPECT_EQ(machine.mode(), before);
    return result.ok() ? std::string() : result.error().reason;
  };
  EXPECT_EQ(reason(in(Mode::kGrounded, false), Request::takeoff(1.0), grounded()),
            "takeoff refused: not armed; send arm first");
  Situation s = grounded();
  s.ready = false;
  s.not_ready_reason = "imu0 is silent";
  EXPECT_EQ(reason(in(Mode::kGrounded, false), Request::arm(), s),
            "arm refused: not ready: imu0 is silent");
  EXPECT_EQ(reason(in(Mode::kGrounded), Request::takeoff(1.0), s),
            "takeoff refused: not ready: imu0 is silent");
  EXPECT_EQ(reason(in(Mode::kGrounded, false), Request::arm(), flying()),
            "arm refused: not on the ground");
  for (const double altitude : {0.1, 50.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(reason(in(Mode::kGrounded), Request::takeoff(altitude), grounded()),
                HasSubstr("is not from 0.30 to 10.00 m"));
  }
  // A commander that was restarted in flight takes it for grounded.
  for (const Request& request : {Request::land(), Request::hover(), Request::go_back()}) {
    EXPECT_THAT(reason(in(Mode::kGrounded, false), request, flying()),
                HasSubstr("refused: it is above the ground, and not by an order"));
  }
  s = grounded();
  s.estimate_ok = false;
  s.estimate_problem = "no pose for 0.6 s";
  EXPECT_EQ(reason(in(Mode::kGrounded), Request::takeoff(1.0), s),
            "takeoff refused: no estimate: no pose for 0.6 s");
  s.on_ground = false;
  EXPECT_EQ(reason(in(Mode::kLand), Request::hover(), s),
            "hover refused: no estimate: no pose for 0.6 s");
  EXPECT_EQ(
      reason(in(Mode::kHover), Request::navigate(1, "waypoint 3 is inside of a wall"), flying()),
      "navigate refused: waypoint 3 is inside of a wall");
  EXPECT_EQ(reason(in(Mode::kLand), Request::hover(), grounded()),
            "hover refused: on the ground already");
  s = flying();
  s.obstacles_problem = "the LIDAR is silent";
  EXPECT_EQ(reason(in(Mode::kHover), Request::assist(), s), "assist refused: the LIDAR is silent");
  EXPECT_TRUE(in(Mode::kHover).request(Request::manual(), s).ok());
  s.sticks_problem = "no remote control";
  EXPECT_EQ(reason(in(Mode::kHover), Request::manual(), s), "manual refused: no remote control");
  EXPECT_EQ(reason(in(Mode::kHover), Request::assist(), s), "assist refused: no remote control");
  EXPECT_EQ(reason(in(Mode::kHover), Request::gps(1, "waypoint 1 is 3.0 m outside of the fence"),
                   flying()),
            "gps refused: waypoint 1 is 3.0 m outside of the fence");
  EXPECT_EQ(reason(in(Mode::kHover), Request::go_back("planner is silent"), flying()),
            "return refused: planner is silent");
}

TEST(ModeMachineEvents, ACompleteFlightReturnsToGroundedAndDisarmed) {
  ModeMachine machine = in(Mode::kIndoorNavigation);
  Situation s = flying();
  EXPECT_FALSE(machine.update(s).has_value());
  s.navigation = Navigation::kFinished;
  EXPECT_EQ(describe(machine.update(s).value()), "Indoor Navigation -> Hover: mission finished");
  ASSERT_TRUE(machine.request(Request::land(), s).ok());
  s.on_ground = true;
  EXPECT_FALSE(machine.update(s).has_value());
  s.now += std::chrono::milliseconds(400);
  EXPECT_FALSE(machine.update(s).has_value());
  s.now += std::chrono::milliseconds(101);
  EXPECT_EQ(describe(machine.update(s).value()), "Land -> Grounded: landed");
  EXPECT_FALSE(machine.armed());
  EXPECT_FALSE(machine.update(s).has_value());
}

TEST(ModeMachineEvents, AHopDoesNotCountAsLanded) {
  ModeMachine machine = in(Mode::kLand);
  Situation s = flying();
  for (int k = 0; k < 50; ++k) {
    s.now += std::chrono::milliseconds(100);
    s.on_ground = k % 4 != 0;  // never on the ground for half a second
    EXPECT_FALSE(machine.update(s).has_value());
  }
  // Time that runs backwards starts the count again.
  s.on_ground = true;
  s.now -= std::chrono::seconds(5);
  EXPECT_FALSE(machine.update(s).has_value());
  s.now += std::chrono::milliseconds(499);
  EXPECT_FALSE(machine.update(s).has_value());
}

TEST(ModeMachineEvents, ALostEstimateLandsFromEveryModeInTheAir) {
  for (const Mode mode : kModes) {
    if (mode == Mode::kGrounded || mode == Mode::kLand) continue;
    ModeMachine machine = in(mode);
    Situation s = flying();
    s.estimate_ok = false;
    s.estimate_problem = "no pose for 0.6 s";
    // It comes before all else that happens in the same tick.
    s.reference_finished = true;
    s.navigation = Navigation::kFinished;
    const auto transition = machine.update(s);
    ASSERT_TRUE(transition.has_value());
    EXPECT_EQ(describe(*transition),
              std::string(to_string(mode)) + " -> Land: estimate lost: no pose for 0.6 s");
    EXPECT_TRUE(machine.level_descent());
    EXPECT_TRUE(machine.armed());
    s.estimate_ok = true;
    EXPECT_FALSE(machine.update(s).has_value());
    EXPECT_FALSE(machine.level_descent());
    EXPECT_EQ(machine.mode(), Mode::kLand);
  }
  for (const bool armed : {false, true}) {
    ModeMachine machine = in(Mode::kGrounded, armed);
    Situation s = grounded();
    s.estimate_ok = false;
    EXPECT_FALSE(machine.update(s).has_value());
  }
}

TEST(ModeMachineEvents, AnEstimateLostWhileLandingLevelsTheDescent) {
  ModeMachine machine = in(Mode::kLand);
  Situation s = flying();
  EXPECT_FALSE(machine.update(s).has_value());
  EXPECT_FALSE(machine.level_descent());
  s.estimate_ok = false;
  EXPECT_FALSE(machine.update(s).has_value());
  EXPECT_TRUE(machine.level_descent());
}

TEST(ModeMachineEvents, FailedNavigationHoversWithItsReason) {
  ModeMachine machine = in(Mode::kIndoorNavigation);
  Situation s = flying();
  s.navigation = Navigation::kFailed;
  s.navigation_problem = "no path to waypoint 2";
  EXPECT_EQ(describe(machine.update(s).value()),
            "Indoor Navigation -> Hover: no path to waypoint 2");
  EXPECT_FALSE(machine.update(s).has_value());
}

using Demand = Situation::Demand;

TEST(ModeMachineEvents, WhatAPolicyDemandsIsDoneFromEveryModeInTheAir) {
  for (const Mode mode : kModes) {
    if (mode == Mode::kGrounded || mode == Mode::kLand) continue;
    Situation s = flying();
    s.demand_reason = "battery low: 19 %";
    s.demand = Demand::kLand;
    ModeMachine lands = in(mode);
    EXPECT_EQ(describe(lands.update(s).value()),
              std::string(to_string(mode)) + " -> Land: battery low: 19 %");

    s.demand = Demand::kReturn;
    ModeMachine returns = in(mode);
    const Mode way_home = mode == Mode::kTakeoff       ? Mode::kLand
                          : mode == Mode::kGpsGuidance ? Mode::kGpsGuidance
                                                       : Mode::kIndoorNavigation;
    EXPECT_EQ(returns.update(s).value().to, way_home) << to_string(mode);
    EXPECT_EQ(returns.returning(), way_home != Mode::kLand);
    EXPECT_FALSE(returns.update(s).has_value()) << "it is on its way";

    s.demand = Demand::kHover;
    ModeMachine stops = in(mode);
    const auto stopped = stops.update(s);
    EXPECT_EQ(stopped.has_value(), mode != Mode::kHover);
    EXPECT_EQ(stops.mode(), Mode::kHover);
  }
  for (const Demand demand : {Demand::kLand, Demand::kReturn, Demand::kHover}) {
    Situation s = flying();
    s.demand = demand;
    EXPECT_FALSE(in(Mode::kLand).update(s).has_value()) << "who lands goes on landing";
    s = grounded();
    s.demand = demand;
    EXPECT_FALSE(in(Mode::kGrounded).update(s).has_value());
  }
}

TEST(ModeMachineEvents, TheWayHomeEndsInALandingWhetherItIsFoundOrNot) {
  for (const Mode mode : {Mode::kIndoorNavigation, Mode::kGpsGuidance}) {
    for (const Navigation end : {Navigation::kFinished, Navigation::kFailed}) {
      ModeMachine machine = in(mode);
      ASSERT_EQ(machine.request(Request::go_back(), flying()).value(), Acceptance::kChanged);
      EXPECT_EQ(machine.request(Request::go_back(), flying()).value(), Acceptance::kUnchanged);
      EXPECT_EQ(machine.mode(), mode);
      ASSERT_TRUE(machine.returning());
      Situation s = flying();
      s.navigation = end;
      s.navigation_problem = "no path to the take-off point";
      EXPECT_EQ(describe(machine.update(s).value()),
                std::string(to_string(mode)) + " -> Land: " +
                    (end == Navigation::kFinished ? "back home"
                                                  : "no way home: no path to the take-off point"));
      EXPECT_FALSE(machine.returning());
    }
    // The mission that was flown before is another thing than the way home.
    ModeMachine machine = in(mode);
    ASSERT_TRUE(machine.request(Request::go_back(), flying()).ok());
    const auto again = machine.request(
        mode == Mode::kGpsGuidance ? Request::gps(kMission) : Request::navigate(kMission),
        flying());
    EXPECT_EQ(again.value(), Acceptance::kChanged);
    EXPECT_FALSE(machine.returning());
  }
}

TEST(ModeMachineEvents, WhoCannotBeSteeredHovers) {
  for (const Mode mode : {Mode::kManual, Mode::kAssistedManual}) {
    ModeMachine machine = in(mode);
    Situation s = flying();
    s.sticks_problem = "the remote control is silent";
    EXPECT_EQ(describe(machine.update(s).value()),
              std::string(to_string(mode)) + " -> Hover: the remote control is silent");
  }
  Situation s = flying();
  s.obstacles_problem = "the LIDAR is silent";
  EXPECT_FALSE(in(Mode::kManual).update(s).has_value());
  EXPECT_EQ(describe(in(Mode::kAssistedManual).update(s).value()),
            "Assisted Manual -> Hover: the LIDAR is silent");
}

TEST(ModeMachineEvents, ATakeoffThatStaysOnTheGroundLandsAndDisarms) {
  ModeMachine machine = in(Mode::kTakeoff);
  Situation s = grounded();
  EXPECT_FALSE(machine.update(s).has_value());
  s.now += std::chrono::seconds(3);
  s.reference_finished = true;
  EXPECT_EQ(machine.update(s).value().to, Mode::kLand);
  EXPECT_EQ(machine.update(s).value().to, Mode::kGrounded);
  EXPECT_FALSE(machine.armed());
}

TEST(ModeMachineEvents, EveryModeInTheAirHasAWayDown) {
  for (const Mode mode : kModes) {
    if (mode == Mode::kGrounded || mode == Mode::kLand) continue;
    ModeMachine machine = in(mode);
    Situation blind = flying();
    blind.estimate_ok = false;
    EXPECT_TRUE(machine.request(Request::land(), blind).ok()) << to_string(mode);
    EXPECT_EQ(machine.mode(), Mode::kLand);
    EXPECT_TRUE(machine.level_descent());
  }
}

TEST(ModeMachine, UnusableParametersThrow) {
  ModeMachine::Params params;
  params.min_altitude = 20.0;
  EXPECT_THROW(ModeMachine{params}, std::invalid_argument);
  params = {};
  params.landed_confirmation = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(ModeMachine{params}, std::invalid_argument);
}

std::string cell(const RequestRule& rule) {
  switch (rule.answer) {
    case RequestRule::Answer::kGo:
      if (rule.request == Kind::kArm) return "arms";
      if (rule.request == Kind::kDisarm) return "disarms";
      return to_string(rule.to);
    case RequestRule::Answer::kAlready:
      return "(" + std::string(rule.reason) + ")";
    case RequestRule::Answer::kRefuse:
      break;
  }
  return "refused";
}

/// What makes it happen, and nothing else.
Situation when(EventRule::Event event) {
  using Event = EventRule::Event;
  Situation s = flying();
  switch (event) {
    case Event::kLanded:
      s.on_ground = true;
      break;
    case Event::kEstimateLost:
      s.estimate_ok = false;
      break;
    case Event::kLandDemanded:
      s.demand = Demand::kLand;
      break;
    case Event::kReturnDemanded:
      s.demand = Demand::kReturn;
      break;
    case Event::kHoverDemanded:
      s.demand = Demand::kHover;
      break;
    case Event::kTakeoffFailed:
      s.on_ground = s.reference_finished = true;
      break;
    case Event::kReferenceFinished:
      s.reference_finished = true;
      break;
    case Event::kReturnFailed:
    case Event::kNavigationFailed:
      s.navigation = Navigation::kFailed;
      break;
    case Event::kReturned:
    case Event::kNavigationFinished:
      s.navigation = Navigation::kFinished;
      break;
    case Event::kSticksSilent:
      s.sticks_problem = "no remote control";
      break;
    case Event::kObstaclesUnseen:
      s.obstacles_problem = "the LIDAR is silent";
      break;
  }
  return s;
}

TEST(ModeMachineEvents, EachInEachModeDoesWhatTheTableSaysAndNothingElse) {
  using Event = EventRule::Event;
  std::size_t happened = 0;
  for (int e = 0; e <= static_cast<int>(Event::kObstaclesUnseen); ++e) {
    const auto event = static_cast<Event>(e);
    for (const Mode mode : kModes) {
      SCOPED_TRACE(std::string(to_string(event)) + " in " + to_string(mode));
      const bool of_return = event == Event::kReturned || event == Event::kReturnFailed;
      const bool can_return = mode == Mode::kGpsGuidance || mode == Mode::kIndoorNavigation;
      if (of_return && !can_return) continue;
      ModeMachine machine;
      machine.restore({mode, mode != Mode::kGrounded, false, 1.0, 7, of_return});
      const auto& rules = event_rules();
      const auto rule = std::find_if(rules.begin(), rules.end(), [&](const EventRule& r) {
        return r.event == event && r.from == mode;
      });
      Situation s = when(event);
      auto transition = machine.update(s);
      if (event == Event::kLanded) {
        EXPECT_FALSE(transition) << "it takes a while";
        s.now += std::chrono::seconds(1);
        transition = machine.update(s);
      }
      ASSERT_EQ(transition.has_value(), rule != rules.end());
      if (!transition) continue;
      ++happened;
      EXPECT_EQ(transition->from, mode);
      EXPECT_EQ(transition->to, rule->to);
      EXPECT_EQ(machine.mode(), rule->to);
      EXPECT_NE(transition->reason, "");
    }
  }
  EXPECT_EQ(happened, event_rules().size());
}

TEST(ModeMachineReadme, ShowsTheTablesOfTheCode) {
  std::ostringstream table;
  table << "| mode |";
  for (const Kind kind : kRequestKinds) table << " " << to_string(kind) << " |";
  table << "\n| --- |";
  for (std::size_t i = 0; i < kRequestKinds.size(); ++i) table << " --- |";
  for (const Row& row : kExpected) {
    table << "\n| " << to_string(row.mode);
    if (row.mode == Mode::kGrounded) table << (row.armed ? ", armed" : ", disarmed");
    table << " |";
    for (const Kind kind : kRequestKinds) {
      table << " " << cell(request_rule(row.mode, row.armed, kind)) << " |";
    }
  }
  table << "\n";
  // Rules that differ in nothing but where they lead from are one line.
  std::ostringstream events;
  events << "| from | what happens | to |\n| --- | --- | --- |\n";
  const std::vector<EventRule>& rules = event_rules();
  for (std::size_t i = 0; i < rules.size(); ++i) {
    const bool goes_on =
        i > 0 && rules[i].event == rules[i - 1].event && rules[i].to == rules[i - 1].to;
    const bool goes_further = i + 1 < rules.size() && rules[i].event == rules[i + 1].event &&
                              rules[i].to == rules[i + 1].to;
    events << (goes_on ? ", " : "| ") << to_string(rules[i].from);
    if (goes_further) continue;
    events << " | " << to_string(rules[i].event) << " | " << to_string(rules[i].to) << " |\n";
  }
  std::ifstream file(SWIFTLET_SOURCE_DIR "/control/README.md");
  std::stringstream readme;
  readme << file.rdbuf();
  EXPECT_THAT(readme.str(), HasSubstr(table.str()));
  EXPECT_THAT(readme.str(), HasSubstr(events.str()));
}

}  // namespace
}  // namespace swiftlet
