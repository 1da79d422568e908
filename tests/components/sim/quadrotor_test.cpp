// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/quadrotor.hpp"

#include <limits>

#include "estimation/geometry/so3.hpp"
#include "tests/components/sim/fixture.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
using std::chrono::milliseconds;

constexpr Duration kStep = milliseconds(1);

Quadrotor::Params without_drag() {
  Quadrotor::Params params;
  params.linear_drag = 0.0;
  params.quadratic_drag = 0.0;
  return params;
}

Quadrotor flying(const Quadrotor::Params& params, const RigidBodyState& body) {
  Quadrotor quadrotor(params);
  EXPECT_TRUE(quadrotor.reset(Time{}, body));
  return quadrotor;
}

void run(Quadrotor& quadrotor, double seconds, const Vector4d& thrusts, const World& world,
         const Vector3d& wind = Vector3d::Zero()) {
  const int steps = static_cast<int>(std::lround(seconds * 1000.0));
  for (int i = 0; i < steps; ++i) quadrotor.step(kStep, thrusts, wind, world);
}

RigidBodyState at(double x, double y, double z) {
  RigidBodyState body;
  body.p_WB << x, y, z;
  return body;
}

TEST(Quadrotor, FallsAsGalileoSays) {
  const World world;
  RigidBodyState body = at(0, 0, 100);
  body.v_WB_W << 3.0, -1.0, 2.0;
  Quadrotor quadrotor = flying(without_drag(), body);
  run(quadrotor, 2.0, Vector4d::Zero(), world);
  const RigidBodyState& end = quadrotor.truth().body;
  EXPECT_NEAR(end.p_WB.x(), 6.0, 1e-9);
  EXPECT_NEAR(end.p_WB.y(), -2.0, 1e-9);
  EXPECT_NEAR(end.p_WB.z(), 100.0 + 4.0 - 0.5 * kGravity * 4.0, 1e-9);
  EXPECT_NEAR(end.v_WB_W.z(), 2.0 - 2.0 * kGravity, 1e-9);
  EXPECT_LT(quadrotor.truth().specific_force.norm(), 1e-9);  // weightless
  EXPECT_EQ(quadrotor.truth().time, Time(std::chrono::seconds(2)));
}

TEST(Quadrotor, HoversOnAQuarterOfItsWeightPerRotor) {
  const World world;
  Quadrotor::Params params = without_drag();
  params.model.rotor_time_constant = 0.0;
  Quadrotor quadrotor = flying(params, at(1, 2, 3));
  run(quadrotor, 10.0, Vector4d::Constant(params.model.mass * kGravity / 4.0), world);
  EXPECT_NEAR((quadrotor.truth().body.p_WB - Vector3d(1, 2, 3)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((quadrotor.truth().specific_force - Vector3d(0, 0, kGravity)).norm(), 0.0, 1e-9);
}

TEST(Quadrotor, TorqueFreeRotationConservesAngularMomentumAndEnergy) {
  const World world;
  Quadrotor::Params params = without_drag();
  params.model.inertia << 5e-3, 8e-3, 12e-3;  // three different axes: it tumbles
  RigidBodyState body = at(0, 0, 1000);
  body.w_WB_B << 0.3, 9.0, 0.2;  // near the unstable axis
  Quadrotor quadrotor = flying(params, body);
  const auto momentum = [&] {
    const RigidBodyState& s = quadrotor.truth().body;
    return Vector3d(s.q_WB * params.model.inertia.cwiseProduct(s.w_WB_B));
  };
  const auto energy = [&] {
    const RigidBodyState& s = quadrotor.truth().body;
    return 0.5 * s.w_WB_B.dot(params.model.inertia.cwiseProduct(s.w_WB_B));
  };
  const Vector3d momentum_0 = momentum();
  const double energy_0 = energy();
  bool turned_over = false;
  for (int i = 0; i < 10000; ++i) {
    quadrotor.step(kStep, Vector4d::Zero(), Vector3d::Zero(), world);
    turned_over |= quadrotor.truth().body.w_WB_B.y() < -8.0;
  }
  EXPECT_NEAR((momentum() - momentum_0).norm() / momentum_0.norm(), 0.0, 1e-7);
  EXPECT_NEAR(energy() / energy_0, 1.0, 1e-7);
  EXPECT_TRUE(turned_over);  // the tennis-racket theorem
}

TEST(Quadrotor, EachRotorTurnsTheBodyTheWayEquation2Says) {
  const World world;
  Quadrotor::Params params = without_drag();
  params.model.rotor_time_constant = 0.0;
  const QuadrotorModel& m = params.model;
  // Rotors front, right, back, left: pitch up (-y), roll right (+x is left down in FLU: -), ...
  const double f = 1.0;
  const Vector3d expected[4] = {{0, -m.arm_length * f, m.torque_per_thrust * f},
                                {-m.arm_length * f, 0, -m.torque_per_thrust * f},
                                {0, m.arm_length * f, m.torque_per_thrust * f},
                                {m.arm_length * f, 0, -m.torque_per_thrust * f}};
  for (int rotor = 0; rotor < 4; ++rotor) {
    Quadrotor quadrotor = flying(params, at(0, 0, 10));
    quadrotor.step(kStep, Vector4d::Unit(rotor) * f, Vector3d::Zero(), world);
    const Vector3d moment = m.inertia.cwiseProduct(quadrotor.truth().angular_acceleration);
    EXPECT_NEAR((moment - expected[rotor]).norm(), 0.0, 1e-3) << rotor;
    EXPECT_NEAR(quadrotor.truth().specific_force.z(), f / m.mass, 1e-3) << rotor;
  }
}

TEST(Quadrotor, RotorsFollowTheirCommandsWithTheirTimeConstant) {
  const World world;
  Quadrotor::Params params = without_drag();
  params.model.rotor_time_constant = 0.05;
  Quadrotor quadrotor = flying(params, at(0, 0, 10));
  run(quadrotor, 0.05, Vector4d::Constant(2.0), world);
  EXPECT_NEAR(quadrotor.truth().rotor_thrusts[0], 2.0 * (1.0 - std::exp(-1.0)), 1e-9);
  // The impulse is exact too: v = (4/m) * integral of f - g t.
  const double integral = 2.0 * (0.05 - 0.05 * (1.0 - std::exp(-1.0)));
  EXPECT_NEAR(quadrotor.truth().body.v_WB_W.z(),
              4.0 * integral / params.model.mass - kGravity * 0.05, 1e-9);
}

TEST(Quadrotor, ThrustStaysWithinItsLimits) {
  const World world;
  Quadrotor quadrotor = flying(without_drag(), at(0, 0, 10));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  run(quadrotor, 1.0, Vector4d(100.0, 1e-3, -3.0, nan), world);
  const Vector4d thrusts = quadrotor.truth().rotor_thrusts;
  EXPECT_NEAR(thrusts[0], quadrotor.params().model.rotor_thrust_max, 1e-6);
  EXPECT_NEAR(thrusts[1], quadrotor.params().model.rotor_thrust_min, 1e-6);
  EXPECT_EQ(thrusts[2], 0.0);
  EXPECT_EQ(thrusts[3], 0.0);
}

TEST(Quadrotor, FallsAtTheSpeedWhereDragIsItsWeight) {
  const World world;
  const Quadrotor::Params params;
  Quadrotor quadrotor = flying(params, at(0, 0, 2000));
  run(quadrotor, 30.0, Vector4d::Zero(), world);
  const double a = params.quadratic_drag;
  const double b = params.linear_drag;
  const double weight = params.model.mass * kGravity;
  const double terminal = (-b + std::sqrt(b * b + 4.0 * a * weight)) / (2.0 * a);
  EXPECT_NEAR(-quadrotor.truth().body.v_WB_W.z(), terminal, 1e-3);
  EXPECT_NEAR(quadrotor.truth().specific_force.z(), kGravity, 1e-3);
}

TEST(Quadrotor, DriftsWithTheWind) {
  const World world;
  Quadrotor::Params params;
  params.model.rotor_time_constant = 0.0;
  Quadrotor quadrotor = flying(params, at(0, 0, 100));
  const Vector3d wind(4.0, -1.0, 0.0);
  run(quadrotor, 60.0, Vector4d::Constant(params.model.mass * kGravity / 4.0), world, wind);
  EXPECT_NEAR((quadrotor.truth().body.v_WB_W - wind).norm(), 0.0, 0.05);
}

TEST(Quadrotor, StaysFiniteWhateverItIsTold) {
  const World world = test::flat_world();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  Quadrotor quadrotor = flying({}, at(0, 0, 1));
  const Vector4d commands[] = {
      {nan, nan, nan, nan}, {infinity, 0, infinity, 0}, {-infinity, 1e300, 0, 5}, {5, 0, 0, 0}};
  for (int i = 0; i < 8000; ++i) {
    quadrotor.step(kStep, commands[(i / 1000) % 4], {i % 7 ? 0.0 : nan, infinity, 0}, world);
    const VehicleTruth& truth = quadrotor.truth();
    ASSERT_TRUE(truth.body.p_WB.allFinite() && truth.body.v_WB_W.allFinite());
    ASSERT_TRUE(truth.body.w_WB_B.allFinite() && truth.specific_force.allFinite());
    ASSERT_NEAR(truth.body.q_WB.norm(), 1.0, 1e-9);
  }
  RigidBodyState broken = at(0, nan, 0);
  EXPECT_FALSE(quadrotor.reset(Time{}, broken));
  EXPECT_TRUE(quadrotor.truth().body.p_WB.allFinite());
  const Time before = quadrotor.truth().time;
  quadrotor.step(-kStep, Vector4d::Zero(), Vector3d::Zero(), world);
  EXPECT_EQ(quadrotor.truth().time, before);
}

TEST(Quadrotor, ALongStepIsManyShortOnes) {
  const World world = test::flat_world();
  Quadrotor coarse = flying({}, at(0, 0, 1));
  Quadrotor fine = flying({}, at(0, 0, 1));
  for (int i = 0; i < 200; ++i) {
    const Vector4d thrusts(2.0, 2.2, 2.0, 2.3);
    coarse.step(milliseconds(5), thrusts, Vector3d::Zero(), world);
    run(fine, 0.005, thrusts, world);
  }
  EXPECT_EQ(coarse.truth().time, fine.truth().time);
  EXPECT_NEAR((coarse.truth().body.p_WB - fine.truth().body.p_WB).norm(), 0.0, 1e-9);
}

}  // namespace
}  // namespace swiftlet
