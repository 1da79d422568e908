// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// A director whose state another one takes over, at any moment of a flight.
#include <random>

#include "tests/control/director_flight.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector3d;

const std::vector<MissionWaypoint> kMission{{Vector3d(2.0, 0.0, 1.2), {}},
                                            {Vector3d(2.0, 2.0, 1.2), {}}};

/// Another director goes on, which has sensed the same and decided nothing so far.
void hand_over(DirectorFlight& flight) {
  FlightDirector successor{settled()};
  successor.restore(flight.director.state());
  flight.director = successor;
  flight.feed();
}

struct Succession : testing::TestWithParam<int> {};

TEST_P(Succession, TheFlightGoesOnWithoutAStep) {
  std::mt19937 random(static_cast<unsigned>(GetParam()));
  DirectorFlight flight;
  flight.answer_once();
  const auto fly_and_hand_over = [&](auto until) {
    for (int tick = 0; tick < 3000 && !until(); ++tick) {
      flight.tick();  // which checks the reference for steps
      if (random() % 50 == 0) hand_over(flight);
    }
    ASSERT_TRUE(until());
  };
  flight.fly_for(0.05);
  ASSERT_TRUE(flight.director.request(Request::arm(), flight.now).ok());
  hand_over(flight);
  ASSERT_TRUE(flight.director.request(Request::takeoff(1.2), flight.now).ok()) << "still armed";
  fly_and_hand_over([&] { return flight.mode() == Mode::kHover; });
  ASSERT_TRUE(flight.director.fly(7, kMission, flight.now).ok());
  fly_and_hand_over([&] { return flight.status().mission_done; });
  EXPECT_LT((flight.vehicle.p_WB - kMission.back().position).norm(), 1e-3);
  EXPECT_EQ(*flight.director.fly(7, kMission, flight.now), Acceptance::kChanged);
  hand_over(flight);
  EXPECT_EQ(*flight.director.fly(7, kMission, flight.now), Acceptance::kUnchanged)
      << "the successor knows which mission is flown";
  ASSERT_TRUE(flight.director.request(Request::hover(), flight.now).ok());
  ASSERT_TRUE(flight.director.request(Request::land(), flight.now).ok());
  fly_and_hand_over([&] { return flight.mode() == Mode::kGrounded; });
  EXPECT_FALSE(flight.status().armed);
  EXPECT_NEAR(flight.vehicle.p_WB.z(), 0.0, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Succession, testing::Range(1, 11));

TEST(SuccessionWithoutState, WhoBeginsAnewInFlightDoesNotCallItLanded) {
  DirectorFlight flight;
  flight.vehicle.p_WB.z() = 1.2;
  flight.feed();
  EXPECT_EQ(flight.mode(), Mode::kGrounded);
  EXPECT_FALSE(flight.status().ready);
  EXPECT_THAT(flight.status().reason, testing::HasSubstr("the ground is 1.15 m below"));
  const auto landing = flight.director.request(Request::land(), flight.now);
  ASSERT_FALSE(landing.ok());
  EXPECT_THAT(landing.error().reason, testing::HasSubstr("land refused: it is above the ground"));
  flight.vehicle.p_WB.z() = 0.0;
  flight.feed();
  EXPECT_TRUE(flight.status().ready) << flight.status().reason;
}

TEST(FlightDirectorGuidance, AMissionEndsInHoverWhenThoseWhoGuideItFallSilent) {
  DirectorFlight flight;
  flight.answer_once();
  flight.take_off();
  ASSERT_TRUE(flight.director.fly(7, kMission, flight.now).ok());
  flight.fly_for(1.5);
  flight.director.set_guidance_problem("the planner fell silent 0.31 s ago");
  flight.fly_for(0.02);
  EXPECT_EQ(flight.mode(), Mode::kHover);
  EXPECT_EQ(flight.status().reason, "the planner fell silent 0.31 s ago");
  flight.fly_for(3.0);
  EXPECT_TRUE(flight.vehicle.v_WB_W.isZero(1e-9)) << "braked to rest";
  const auto again = flight.director.fly(8, kMission, flight.now);
  ASSERT_FALSE(again.ok());
  EXPECT_THAT(again.error().reason, testing::HasSubstr("the planner fell silent"));
  flight.director.set_guidance_problem("");
  EXPECT_TRUE(flight.director.fly(8, kMission, flight.now).ok());
}

TEST(FlightDirectorReadiness, AProblemElsewhereOnBoardKeepsFromArming) {
  DirectorFlight flight;
  flight.fly_for(0.05);
  flight.director.set_system_problem("estimator: phone/pose: nobody writes it");
  const auto refused = flight.director.request(Request::arm(), flight.now);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().reason, testing::HasSubstr("phone/pose: nobody writes it"));
  flight.director.set_system_problem("");
  EXPECT_TRUE(flight.director.request(Request::arm(), flight.now).ok());
  ASSERT_TRUE(flight.director.request(Request::takeoff(1.0), flight.now).ok());
  ASSERT_TRUE(flight.fly_until(Mode::kHover, 10.0));
  flight.director.set_system_problem("lidar_mapper: scan: silent for 0.50 s");
  flight.fly_for(1.0);
  EXPECT_EQ(flight.mode(), Mode::kHover) << "in flight it is for those who are concerned";
}

}  // namespace
}  // namespace swiftlet::test
