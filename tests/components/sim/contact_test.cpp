// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/contact.hpp"

#include "components/sim/quadrotor.hpp"
#include "components/sim/random_stream.hpp"
#include "estimation/geometry/so3.hpp"
#include "tests/components/sim/fixture.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr Duration kStep = std::chrono::milliseconds(1);

class Contact : public testing::Test {
 protected:
  void put(const Vector3d& p, const Eigen::Quaterniond& q = Eigen::Quaterniond::Identity(),
           const Vector3d& v = Vector3d::Zero()) {
    RigidBodyState body;
    body.p_WB = p;
    body.q_WB = q;
    body.v_WB_W = v;
    ASSERT_TRUE(quadrotor.reset(Time{}, body));
  }
  void run(double seconds, const Vector3d& wind = Vector3d::Zero(),
           const Vector4d& thrusts = Vector4d::Zero()) {
    for (int i = 0; i < static_cast<int>(std::lround(1000.0 * seconds)); ++i) {
      quadrotor.step(kStep, thrusts, wind, world);
      ASSERT_TRUE(body().p_WB.allFinite());
      lowest = std::min(lowest, body().p_WB.z());
      highest = std::max(highest, body().p_WB.z());
      fastest = std::max(fastest, body().v_WB_W.norm());
    }
  }
  void add_wall(double x) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() << x + 0.05, 0.0, 1.25;
    world.add_box("wall", T, {0.1, 6.0, 2.5});
  }
  const RigidBodyState& body() const { return quadrotor.truth().body; }

  World world = test::flat_world();
  Quadrotor::Params params;
  Quadrotor quadrotor{params};
  double lowest = 1e9;
  double highest = -1e9;
  double fastest = 0.0;
};

TEST_F(Contact, RestsStillOnTheGroundForAMinute) {
  put({1.0, -2.0, params.ground.leg_height}, from_yaw(0.7));
  run(2.0);
  const RigidBodyState settled = body();
  EXPECT_NEAR(settled.p_WB.z(), params.ground.leg_height, 5e-3);
  run(60.0);
  EXPECT_LT((body().p_WB - settled.p_WB).norm(), 1e-6);
  EXPECT_LT(log_so3(settled.q_WB.conjugate() * body().q_WB).norm(), 1e-6);
  EXPECT_LT(body().v_WB_W.norm(), 1e-6);
  EXPECT_NEAR((quadrotor.truth().specific_force - Vector3d(0, 0, kGravity)).norm(), 0.0, 1e-6);
  EXPECT_TRUE(quadrotor.truth().on_ground);
  EXPECT_EQ(quadrotor.hull().count(), 0);
}

TEST_F(Contact, WindBelowTheFrictionLimitDoesNotPushItAlong) {
  put({0, 0, params.ground.leg_height});
  run(2.0);
  const Vector3d settled = body().p_WB;
  run(60.0, {5.0, 0.0, 0.0});  // 1 N of drag against 7 N of friction
  EXPECT_LT((body().p_WB - settled).norm(), 0.005);
  const Vector3d after_a_minute = body().p_WB;
  run(60.0, {5.0, 0.0, 0.0});
  EXPECT_LT((body().p_WB - after_a_minute).norm(), 1e-6);
  run(20.0, {30.0, 0.0, 0.0});  // 21 N
  EXPECT_GT(body().p_WB.x(), 1.0);
}

TEST_F(Contact, SlidesAsFarAsCoulombSays) {
  params.linear_drag = params.quadratic_drag = 0.0;
  params.ground.leg_spread = 0.4;  // broad legs: it slides and does not tip over
  quadrotor = Quadrotor(params);
  put({0, 0, params.ground.leg_height});
  run(2.0);
  RigidBodyState sliding = body();
  sliding.v_WB_W.x() = 1.0;
  ASSERT_TRUE(quadrotor.reset(Time{}, sliding));
  run(3.0);
  const double expected = 1.0 / (2.0 * params.ground.friction * kGravity);
  EXPECT_NEAR(body().p_WB.x(), expected, 0.25 * expected);
  EXPECT_LT(body().v_WB_W.norm(), 1e-4);
}

TEST_F(Contact, ADropFromAMetreEndsAtRestWithoutGainOfEnergy) {
  put({0, 0, 1.0 + params.ground.leg_height});
  run(5.0);
  EXPECT_LE(highest, 1.0 + params.ground.leg_height);
  EXPECT_LT(fastest, std::sqrt(2.0 * kGravity * 1.05));
  EXPECT_GT(lowest, 0.0);
  EXPECT_NEAR(body().p_WB.z(), params.ground.leg_height, 5e-3);
  EXPECT_LT(body().v_WB_W.norm(), 1e-4);
  EXPECT_EQ(quadrotor.hull().count(), 0);
}

TEST_F(Contact, DropsInAnyAttitudeAndFromAnyHeightComeToRestAboveTheGround) {
  RandomStream random(9, "drops");
  for (int i = 0; i < 30; ++i) {
    put({0, 0, 0.5 + 20.0 * random.uniform()}, exp_so3(2.0 * random.normal3()),
        3.0 * random.normal3());
    fastest = 0.0;
    run(15.0);
    EXPECT_GT(body().p_WB.z(), 0.0) << i;
    EXPECT_LT(body().p_WB.z(), 0.3) << i;
    EXPECT_LT(body().v_WB_W.norm(), 0.02) << i;
    EXPECT_LT(fastest, 40.0) << i;
  }
}

TEST_F(Contact, HittingAWallIsCountedWithItsName) {
  add_wall(2.0);
  put({0, 0, 1.5}, Eigen::Quaterniond::Identity(), {2.0, 0, 4.0});
  run(1.5);
  ASSERT_EQ(quadrotor.hull().count(), 1);
  const Collision& hit = quadrotor.hull().collisions().front();
  EXPECT_EQ(hit.model, "wall");
  EXPECT_NEAR(hit.point.x(), 2.0, 1e-6);
  EXPECT_NEAR(hit.speed, 1.8, 0.2);
  EXPECT_NEAR(to_seconds(hit.time), 1.75 / 1.9, 0.05);
  EXPECT_LT(body().p_WB.x(), 1.75);  // thrown back
  EXPECT_LT(quadrotor.hull().min_clearance(), 0.0);
}

TEST_F(Contact, LeaningOnAWallIsOneContactUntilItHasLeft) {
  params.linear_drag = params.quadratic_drag = 0.0;
  quadrotor = Quadrotor(params);
  add_wall(2.0);
  const double hover = params.model.mass * kGravity / 4.0;
  put({1.0, 0, 1.2}, Eigen::Quaterniond::Identity(), {1.0, 0, 0});
  run(0.3, Vector3d::Zero(), Vector4d::Constant(hover));
  EXPECT_EQ(quadrotor.hull().count(), 0);
  run(1.7, Vector3d::Zero(), Vector4d::Constant(hover));
  EXPECT_EQ(quadrotor.hull().count(), 1);
}

TEST_F(Contact, FastVehiclesDoNotPassThroughThinWalls) {
  add_wall(2.0);
  for (const double speed : {3.0, 8.0, 12.0}) {
    put({0, 0, 1.2}, Eigen::Quaterniond::Identity(), {speed, 0, 2.0});
    run(1.0);
    EXPECT_LT(body().p_WB.x(), 2.0) << speed;
    EXPECT_EQ(quadrotor.hull().count(), 1) << speed;
  }
}

TEST_F(Contact, ClearanceIsTheSmallestDistanceOfTheWholeFlight) {
  params.linear_drag = params.quadratic_drag = 0.0;
  quadrotor = Quadrotor(params);
  add_wall(2.0);
  // A parabola towards the wall and back: nearest at the turning point.
  put({0.5, 0, 2.0}, Eigen::Quaterniond::Identity(), {0.0, 1.0, 0.0});
  double expected = 1e9;
  const Vector4d hover = Vector4d::Constant(params.model.mass * kGravity / 4.0);
  for (int i = 0; i < 3000; ++i) {
    const Vector3d wind = Vector3d::Zero();
    expected = std::min(expected, 2.0 - body().p_WB.x() - params.hull.radius);
    quadrotor.step(kStep, hover + 0.01 * std::cos(2e-3 * i) * Vector4d(-1, 0, 1, 0), wind, world);
    if (body().p_WB.z() < 0.5) break;
  }
  EXPECT_NEAR(quadrotor.hull().min_clearance(), expected, 1e-6);
  EXPECT_LT(expected, 1.2);
}

TEST_F(Contact, AWallIsNotForgottenByAVehicleThatTurnsBack) {
  add_wall(2.0);
  put({1.0, 0, 1.5}, Eigen::Quaterniond::Identity(), {-2.0, 0, 0});
  const Vector3d wind(12.0, 0.0, 0.0);
  run(0.3, wind, Vector4d::Constant(params.model.mass * kGravity / 4.0));
  EXPECT_LT(body().p_WB.x(), 0.8);
  EXPECT_EQ(quadrotor.hull().count(), 0);
  run(1.2, wind, Vector4d::Constant(params.model.mass * kGravity / 4.0));
  EXPECT_GE(quadrotor.hull().count(), 1);
  EXPECT_LT(quadrotor.hull().min_clearance(), 0.0);
}

TEST_F(Contact, AnObstacleThatAppearsIsSeenAtOnce) {
  const Vector4d hover = Vector4d::Constant(params.model.mass * kGravity / 4.0);
  put({0, 0, 1.2});
  run(0.5, Vector3d::Zero(), hover);
  EXPECT_TRUE(std::isinf(quadrotor.hull().min_clearance()));
  add_wall(0.5);
  quadrotor.step(kStep, hover, Vector3d::Zero(), world);
  EXPECT_NEAR(quadrotor.hull().min_clearance(), 0.25, 0.02);
}

}  // namespace
}  // namespace swiftlet
