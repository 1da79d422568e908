// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// Missions that are uploaded first and flown later, with the whole stack in lockstep.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "estimation/geodesy/local_origin.hpp"
#include "mode_flight.hpp"

namespace swiftlet::test {
namespace {

using ::testing::HasSubstr;
using Kind = MissionItem::Kind;
using MissionState = swiftlet_msgs::msg::MissionState;
namespace code = swiftlet_msgs::msg::ModeCommand_Constants;
namespace states = swiftlet_msgs::msg::MissionState_Constants;

const LocalOrigin kOrigin({47.397742, 8.545594, 488.0});  // of courtyard.sdf

MissionItem at(const Eigen::Vector3d& place, double hold = 0.0) {
  MissionItem item;
  item.place.position = place;
  item.hold = hold;
  return item;
}
MissionItem on_earth(const Eigen::Vector3d& place) {
  const GlobalPosition there = kOrigin.to_global(place);
  MissionItem item;
  item.global = GlobalWaypoint{there.latitude, there.longitude, place.z()};
  return item;
}
MissionItem of(Kind kind, double altitude = 0.0) {
  MissionItem item;
  item.kind = kind;
  item.altitude = altitude;
  return item;
}

/// A pilot who uploads missions, too.
struct UploadedFlight : ModeFlight {
  explicit UploadedFlight(const std::string& parameters = "") : ModeFlight(parameters) {
    parts = pilot().advertise(topic::mission_upload);
    pilot().subscribe(topic::mission_state, [this](const MissionState& now) { state = now; });
  }
  void upload(const std::vector<MissionItem>& mission, const std::string& id = "m") {
    add({"upload",
         [this, mission, id] {
           std::vector<swiftlet_msgs::msg::MissionItem> items;
           for (const MissionItem& item : mission) items.push_back(to_msg(item));
           std::vector<std::uint32_t> all(items.size());
           std::iota(all.begin(), all.end(), 0U);
           for (const auto& part : make_parts(pilot().now(), id, items, all)) parts.publish(part);
         },
         [this, id] { return state.id() == id || state.upload_refused(); },
         5.0,
         {}});
  }
  void arm() {
    add({"ready", [] {}, [this] { return pilot().status.ready(); }, 30.0, {}});
    add({"arm",
         [this] { pilot().command(code::ARM); },
         [this] { return pilot().status.armed(); },
         5.0,
         {}});
  }
  void start() {
    add({"start",
         [this] { pilot().command(code::MISSION_START); },
         [this] { return state.state() == states::FLYING; },
         5.0,
         {}});
  }
  void until_item(unsigned item, double limit_s = 60.0) {
    add({"until item", [] {}, [this, item] { return state.item() == item; }, limit_s, {}});
  }
  void until_state(std::uint8_t wanted, double limit_s = 120.0) {
    add({"until state", [] {}, [this, wanted] { return state.state() == wanted; }, limit_s, {}});
  }

  Publisher<swiftlet_msgs::msg::MissionPart> parts;
  MissionState state;
};

TEST(UploadedMission, FromTheGroundThroughTheMapOverTheEarthAndBack) {
  UploadedFlight flight;
  ScriptedPilot& pilot = flight.pilot();
  flight.upload({of(Kind::kTakeoff, 1.2), at({8.5, 6.5, 1.2}, 1.0), on_earth({8.5, 11.0, 3.5}),
                 on_earth({3.0, 11.0, 3.5}), on_earth({3.0, 4.0, 3.5}), of(Kind::kReturn)});
  flight.arm();
  flight.start();
  flight.until_item(2);
  flight.check([&] {
    EXPECT_NEAR(pilot.truth.z(), 1.2, 0.15);
    EXPECT_EQ(pilot.status.mission_id(), "m") << "what is flown";
  });
  flight.until_item(4, 90.0);
  flight.check([&] {
    EXPECT_TRUE(pilot.is_in("GPS Guidance"));
    EXPECT_LT((pilot.truth - Eigen::Vector3d(8.5, 11.0, 3.5)).norm(), 2.0);
  });
  flight.until_state(states::DONE);
  flight.check([&] {
    EXPECT_TRUE(pilot.is_in("Grounded"));
    EXPECT_LT((pilot.truth - Eigen::Vector3d(3.0, 4.0, 0.0)).head<2>().norm(), 0.5);
  });
  flight.fly();
}

TEST(UploadedMission, PausedByThePilotItGoesOnWhereItWas) {
  UploadedFlight flight;
  ScriptedPilot& pilot = flight.pilot();
  flight.upload({at({4.5, 4.0, 1.2}), at({4.5, 6.0, 1.2}), at({3.0, 6.5, 1.2})});
  flight.take_off();
  flight.start();
  flight.until_item(2);
  flight.hold({0.0, 0.0, 0.6, 0.0, false}, 1.5);  // takes over by the stick
  flight.until_state(states::PAUSED, 2.0);
  flight.check([&] {
    EXPECT_TRUE(pilot.is_in("Manual"));
    EXPECT_EQ(flight.state.item(), 2U);
  });
  flight.wait(1.5);
  flight.start();
  flight.until_state(states::DONE);
  flight.check([&] { EXPECT_LT((pilot.truth - Eigen::Vector3d(3.0, 6.5, 1.2)).norm(), 0.3); });
  flight.land();
  flight.fly();
}

TEST(UploadedMission, WhatCannotBeFlownIsRefusedWithItsItem) {
  UploadedFlight flight("commander: {fence_radius: 8.0}");
  flight.upload({at({4.0, 4.0, 1.2}), at({30.0, 4.0, 1.2})});
  flight.check([&] {
    EXPECT_TRUE(flight.state.upload_refused());
    EXPECT_THAT(flight.state.upload_reason(), HasSubstr("mission refused: item 2: "));
    EXPECT_EQ(flight.state.state(), states::NONE);
  });
  flight.fly();
}

}  // namespace
}  // namespace swiftlet::test
