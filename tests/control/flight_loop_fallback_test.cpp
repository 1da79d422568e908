// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// FlightLoop when something is missing: the setpoint, the estimate, or both.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "estimation/geometry/so3.hpp"
#include "tests/control/loop_flight.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
using Behaviour = FlightLoop::Behaviour;
using Flight = LoopFlight;
using ::testing::HasSubstr;

TEST(FlightLoop, WithoutSetpointsItBrakesWithinAShortDistanceAndHolds) {
  Flight flight;
  flight.cruises();
  flight.fly_for(2.0);
  ASSERT_NEAR(flight.vehicle.v.x(), 1.0, 0.02);
  flight.commander = false;  // the last setpoint was sent 10 ms ago
  const double from = flight.vehicle.p.x();
  double furthest = from;
  for (int k = 0; k < 1500; ++k) {
    flight.step();
    furthest = std::max(furthest, flight.vehicle.p.x());
    ASSERT_LT(flight.vehicle.tilt(), 0.6);
  }
  EXPECT_LT(furthest - from, 0.4) << "the braking distance";
  EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleSetpoint);
  // A place, not only an attitude: pushed, it comes back.
  const Vector3d place = flight.vehicle.p;
  flight.vehicle.p.y() += 0.2;
  flight.fly_for(1.3);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleSetpoint);
  EXPECT_LT((flight.vehicle.p - place).norm(), 0.05);
  EXPECT_LT(flight.vehicle.v.norm(), 0.1);
}

TEST(FlightLoop, AnAbandonedFlightLandsAndStopsItsMotors) {
  struct Case {
    const char* what;
    double blind_range;  // what the sonar reads, whatever is below; NaN: as it should
    bool has_sonar;
    double sinks_at_most;  // of the reference, below the ground [m]
  };
  for (const Case& c :
       {Case{"a sonar that works", kNan, true, 0.2}, Case{"no sonar", kNan, false, 0.5},
        Case{"a sonar that sees no ground", 3.0, true, 1.1}}) {
    Flight flight;
    flight.floor = 0.12;
    if (c.has_sonar) {
      flight.sonar = [&] {
        return std::isnan(c.blind_range) ? std::max(0.15, flight.vehicle.p.z() - 0.05)
                                         : c.blind_range;
      };
    }
    flight.fly_for(0.5);
    flight.commander = false;
    flight.fly_for(2.9);
    EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleSetpoint);
    EXPECT_NEAR(flight.vehicle.p.z(), 2.0, 0.05);
    flight.fly_for(0.2);
    EXPECT_EQ(flight.output.behaviour, Behaviour::kAbandoned) << c.what;
    EXPECT_THAT(describe(flight.output), HasSubstr("abandoned for 3."));
    double lowest = 2.0, fastest = 0.0;
    bool stopped_in_the_air = false;
    for (int k = 0; k < 12000 && flight.output.armed(); ++k) {
      lowest = std::min(lowest, flight.output.reference.position.z());
      fastest = std::min(fastest, flight.vehicle.v.z());
      flight.step();
      stopped_in_the_air |= !flight.output.armed() && flight.vehicle.p.z() > 0.13;
    }
    EXPECT_EQ(flight.output.behaviour, Behaviour::kLanded) << c.what;
    EXPECT_FALSE(stopped_in_the_air) << c.what;
    EXPECT_NEAR(fastest, -0.4, 0.05) << c.what;
    EXPECT_GT(lowest, 0.12 - c.sinks_at_most) << c.what;
    flight.fly_for(1.0);
    EXPECT_EQ(flight.output.rotor_thrusts, Vector4d::Zero());
  }
}

/// A commander who comes back at any moment of the brake, the hold or the landing is followed at
/// once, and nothing that is commanded steps by more than the vehicle can follow.
TEST(FlightLoop, ACommanderWhoIsBackIsFollowedAtOnceWithoutAStep) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> gap(0.04, 5.0);
  for (int round = 0; round < 40; ++round) {
    Flight flight;
    flight.cruises();
    flight.fly_for(1.0);
    const double silent = gap(random);
    double steepest = 0.0;  // turn of the commanded attitude in one step [rad]
    Eigen::Quaterniond commanded = flight.output.tracking.q_WC;
    const auto fly_for = [&](double seconds) {
      for (int k = 0; k < static_cast<int>(seconds * 250.0); ++k) {
        for (int ms = 0; ms < 4; ++ms) flight.step();
        const Eigen::Quaterniond next = flight.output.tracking.q_WC;
        steepest = std::max(steepest, log_so3(commanded.conjugate() * next).norm());
        commanded = next;
        ASSERT_LT(flight.vehicle.tilt(), 0.7);
      }
    };
    flight.commander = false;
    fly_for(silent);
    flight.commander = true;
    fly_for(0.016);
    EXPECT_EQ(flight.output.behaviour, Behaviour::kTracking) << "silent for " << silent;
    fly_for(2.0 + 2.5 * silent);
    EXPECT_LT((flight.vehicle.p - cruise(flight.t()).position).norm(), 0.05)
        << "silent for " << silent;
    EXPECT_LT(steepest, 0.03) << "silent for " << silent;
  }
}

TEST(FlightLoop, WithoutEstimatesTheImuCarriesTheReferenceOn) {
  Flight flight;
  flight.reference = circle;
  flight.vehicle.place(flat_state(circle(0.0)));
  flight.fly_for(1.001);  // an estimate came just now
  flight.estimator = false;
  flight.fly_for(0.027);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kTracking) << "three periods are not over";
  flight.fly_for(0.002);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kInertial);
  EXPECT_THAT(describe(flight.output), HasSubstr("no odometry for 0.03 s"));
  for (int k = 0; k < 215; ++k) {
    flight.step();
    ASSERT_EQ(flight.output.behaviour, Behaviour::kInertial);
    ASSERT_LT((flight.vehicle.p - circle(flight.t()).position).norm(), 0.12);
    ASSERT_LT((flight.loop.state().p_WB - flight.vehicle.p).norm(), 0.03);
  }
  flight.fly_for(0.02);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleEstimate);
}

TEST(FlightLoop, AnEstimateThatComesBackElsewhereIsTakenGently) {
  // 5 cm: another estimator took over. For longer than the position is carried on: in the descent.
  for (const double gap : {0.1, 0.2, 0.6}) {
    Flight flight;
    flight.fly_for(1.0);
    flight.estimator = false;
    flight.fly_for(gap);
    flight.estimator = true;
    flight.estimate_offset = Vector3d(0.04, -0.03, 0.0);
    double steepest = 0.0;
    for (int k = 0; k < 3000; ++k) {
      flight.step();
      steepest = std::max(steepest, flight.vehicle.tilt());
    }
    EXPECT_LT(steepest, 0.10) << gap;
    EXPECT_EQ(flight.output.behaviour, Behaviour::kTracking);
    EXPECT_LT((flight.vehicle.p + flight.estimate_offset - Vector3d(0, 0, 2)).norm(), 0.02) << gap;
  }
}

TEST(FlightLoop, WithoutAnEstimateForLongerItBrakesAndSinksAndThenKeepsLevel) {
  for (const Duration ahead : {Duration(0), Duration(std::chrono::hours(1))}) {
    Flight flight;
    flight.vehicle.p.z() = 20.0;
    flight.reference = [](double t) {
      FlatReference reference = cruise(t);
      reference.position.z() = 20.0;
      return reference;
    };
    flight.vehicle.place(flat_state(flight.reference(0.0)));
    flight.fly_for(1.0);
    flight.estimator = ahead != Duration(0);
    flight.estimates_ahead = ahead;  // a clock that is wrong is as good as none
    flight.fly_for(0.3);
    EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleEstimate);
    const double from = flight.vehicle.p.x();
    flight.fly_for(1.2);
    EXPECT_LT((flight.vehicle.v - Vector3d(0, 0, -0.4)).norm(), 0.05);
    EXPECT_LT(flight.vehicle.p.x() - from, 0.4);
    flight.fly_for(2.4);
    EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleEstimate);
    EXPECT_LT((flight.vehicle.v - Vector3d(0, 0, -0.4)).norm(), 0.05);
    flight.fly_for(0.2);
    EXPECT_EQ(flight.output.behaviour, Behaviour::kBlind) << "4 s after the last estimate";
    for (int k = 0; k < 3000; ++k) {
      flight.step();
      ASSERT_LT(flight.vehicle.tilt(), 0.05);
    }
    EXPECT_NEAR(flight.output.rotor_thrusts.sum(), 0.95 * QuadrotorModel{}.mass * kGravity, 0.02);
  }
}

TEST(FlightLoop, TheIntegralHoldsAgainstTheWindWhileItSinks) {
  Flight flight;
  flight.vehicle.wind_force = Vector3d(0.6, 0, 0);  // 0.7 m/s^2
  flight.fly_for(8.0);
  ASSERT_LT((flight.vehicle.p - Vector3d(0, 0, 2)).norm(), 0.03);
  flight.estimator = false;
  flight.fly_for(3.5);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleEstimate);
  EXPECT_LT(flight.vehicle.p.head<2>().norm(), 0.05);
}

TEST(FlightLoop, LevelBrakesAndSinksAndTrustsNoPosition) {
  Flight flight;
  flight.cruises();
  flight.fly_for(1.0);
  const double from = flight.vehicle.p.x();
  flight.kind = SetpointKind::kLevel;
  flight.fly_for(1.5);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kLevel);
  EXPECT_LT(flight.vehicle.p.x() - from, 0.4);
  EXPECT_LT((flight.vehicle.v - Vector3d(0, 0, -0.4)).norm(), 0.03);
  for (int k = 0; k < 1000; ++k) {
    if (k % 100 == 0) flight.estimate_offset = Vector3d(k % 200 == 0 ? 1.0 : -1.0, 0.5, 0);
    flight.step();
    ASSERT_LT(flight.vehicle.tilt(), 0.03) << "a jump of the position is not flown after";
  }
}

TEST(FlightLoop, WithNeitherSetpointNorEstimateTheSonarEndsTheDescent) {
  for (const bool has_sonar : {true, false}) {
    Flight flight;
    flight.floor = 0.12;
    flight.vehicle.p.z() = 1.25;
    flight.reference = [](double) { return hover_at(Vector3d(0, 0, 1.25)); };
    if (has_sonar) flight.sonar = [&] { return std::max(0.15, flight.vehicle.p.z() - 0.05); };
    flight.fly_for(1.0);
    flight.estimator = flight.commander = false;
    double on_ground = 0.0;  // while the motors ran [s]
    for (int k = 0; k < 10000 && flight.output.armed(); ++k) {
      flight.step();
      if (flight.vehicle.p.z() < 0.13) on_ground += 1e-3;
      ASSERT_TRUE(flight.output.armed() || flight.vehicle.p.z() < 0.13);
    }
    if (has_sonar) {
      EXPECT_EQ(flight.output.behaviour, Behaviour::kLanded);
      EXPECT_NEAR(on_ground, 0.25, 0.2) << "the sonar sees it from 0.1 m on";
    } else {
      EXPECT_EQ(flight.output.behaviour, Behaviour::kBlind) << "nobody knows, so it sinks for ever";
    }
  }
}

TEST(FlightLoop, MotorsOffAfterAGapIsNotObeyedInTheAir) {
  Flight flight;
  flight.floor = 0.12;
  flight.fly_for(0.5);
  flight.commander = false;
  flight.fly_for(0.4);
  // Started again, and knows nothing.
  flight.commander = true;
  flight.kind = SetpointKind::kMotorsOff;
  flight.fly_for(0.2);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kStaleSetpoint);
  EXPECT_NEAR(flight.vehicle.p.z(), 2.0, 0.02);
  bool told = false;
  for (int k = 0; k < 20; ++k) flight.step(), told |= flight.output.motors_off_refused;
  EXPECT_TRUE(told);
  // One who wants to fly is followed; then "off" is his to say.
  Flight taken_over = flight;
  taken_over.kind = SetpointKind::kTrack;
  taken_over.fly_for(0.02);
  EXPECT_EQ(taken_over.output.behaviour, Behaviour::kTracking);
  taken_over.kind = SetpointKind::kMotorsOff;
  taken_over.fly_for(0.02);
  EXPECT_EQ(taken_over.output.behaviour, Behaviour::kMotorsOff);
  // Else it lands, and on the ground "off" is heard.
  flight.fly_for(9.0);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kMotorsOff);
  EXPECT_NEAR(flight.vehicle.p.z(), 0.12, 1e-9);
}

TEST(FlightLoop, AfterALandingByItselfItTakesOffAgainOnlyAfterMotorsOff) {
  Flight flight;
  flight.floor = 0.12;
  flight.fly_for(0.5);
  flight.commander = false;
  flight.fly_for(10.0);
  ASSERT_EQ(flight.output.behaviour, Behaviour::kLanded);
  EXPECT_EQ(describe(flight.output), "landed by itself: motors off");
  flight.commander = true;  // was only slow, and wants to go on at 2 m
  flight.fly_for(0.5);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kLanded);
  flight.kind = SetpointKind::kMotorsOff;
  flight.fly_for(0.1);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kMotorsOff);
  flight.kind = SetpointKind::kTrack;
  flight.fly_for(0.1);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kTracking);
}

TEST(FlightLoop, ABrokenAccelerometerIsNotBelievedWithoutOdometry) {
  Flight flight;
  flight.fly_for(1.0);
  flight.estimator = false;
  for (int k = 0; k < 400; ++k) {
    flight.specific_force.x() = kNan;
    flight.step();
    ASSERT_TRUE(flight.output.rotor_thrusts.allFinite());
  }
  EXPECT_EQ(flight.output.behaviour, Behaviour::kBlind);
  flight.estimator = true;
  flight.fly_for(0.02);
  EXPECT_EQ(flight.output.behaviour, Behaviour::kTracking);
}

}  // namespace
}  // namespace swiftlet::test
