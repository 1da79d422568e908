// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/quadrotor.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;

namespace {

constexpr double kLongestStep = 1e-3;  // [s]
// Beyond these the model means nothing; they keep a vehicle that lost control finite.
constexpr double kSpeedLimit = 200.0;   // [m/s]
constexpr double kRateLimit = 200.0;    // [rad/s]
constexpr double kPositionLimit = 1e6;  // [m]

/// What acts on the body during one step.
struct Loads {
  double thrust;      // along z of the body [N]
  Vector3d moment_B;  // of the rotors and of contact [N m]
  Vector3d force_W;   // of contact and of who pushes [N]
  Vector3d wind;      // velocity of the air [m/s]
};

struct Derivative {
  Vector3d p;
  Eigen::Vector4d q;  // coefficients in Eigen's order x, y, z, w
  Vector3d v;
  Vector3d w;
};

/// Equation 1 of seed 000 in ENU/FLU, with drag and contact.
Derivative equation_1(const RigidBodyState& s, const Quadrotor::Params& params,
                      const Loads& loads) {
  const QuadrotorModel& model = params.model;
  const Vector3d airspeed = s.v_WB_W - loads.wind;
  const Vector3d drag = -(params.linear_drag + params.quadratic_drag * airspeed.norm()) * airspeed;
  const Vector3d force =
      s.q_WB.normalized() * Vector3d(0.0, 0.0, loads.thrust) + drag + loads.force_W;
  const Vector3d momentum = model.inertia.cwiseProduct(s.w_WB_B);
  Derivative d;
  d.p = s.v_WB_W;
  d.q = 0.5 * (s.q_WB * Quaterniond(0.0, s.w_WB_B.x(), s.w_WB_B.y(), s.w_WB_B.z())).coeffs();
  d.v = force / model.mass - Vector3d(0.0, 0.0, kGravity);
  d.w = (loads.moment_B - s.w_WB_B.cross(momentum)).cwiseQuotient(model.inertia);
  return d;
}

RigidBodyState advance(const RigidBodyState& s, const Derivative& d, double dt) {
  RigidBodyState next;
  next.p_WB = s.p_WB + dt * d.p;
  next.q_WB.coeffs() = s.q_WB.coeffs() + dt * d.q;
  next.v_WB_W = s.v_WB_W + dt * d.v;
  next.w_WB_B = s.w_WB_B + dt * d.w;
  return next;
}

RigidBodyState runge_kutta(const RigidBodyState& s, const Quadrotor::Params& params,
                           const Loads& loads, double dt) {
  const Derivative a = equation_1(s, params, loads);
  const Derivative b = equation_1(advance(s, a, 0.5 * dt), params, loads);
  const Derivative c = equation_1(advance(s, b, 0.5 * dt), params, loads);
  const Derivative d = equation_1(advance(s, c, dt), params, loads);
  const Derivative mean{
      (a.p + 2.0 * b.p + 2.0 * c.p + d.p) / 6.0, (a.q + 2.0 * b.q + 2.0 * c.q + d.q) / 6.0,
      (a.v + 2.0 * b.v + 2.0 * c.v + d.v) / 6.0, (a.w + 2.0 * b.w + 2.0 * c.w + d.w) / 6.0};
  RigidBodyState next = advance(s, mean, dt);
  next.q_WB.normalize();
  return next;
}

bool is_finite(const RigidBodyState& s) {
  return s.p_WB.allFinite() && s.q_WB.coeffs().allFinite() && s.v_WB_W.allFinite() &&
         s.w_WB_B.allFinite();
}

void limit(Vector3d& v, double largest) {
  const double norm = v.norm();
  if (norm > largest) v *= largest / norm;
}

}  // namespace

Quadrotor::Quadrotor(const Params& params)
    : params_(params),
      allocation_(allocation_matrix(params.model)),
      ground_(params.ground, params.model),
      hull_(params.hull, params.model) {}

bool Quadrotor::reset(Time time, const RigidBodyState& body) {
  if (!is_finite(body) || body.q_WB.norm() < 1e-6) return false;
  truth_ = {};
  truth_.time = time;
  truth_.body = body;
  truth_.body.q_WB.normalize();
  ground_.reset();
  hull_ = HullContact(params_.hull, params_.model);
  return true;
}

void Quadrotor::step(Duration dt, const Vector4d& thrust_commands, const Vector3d& wind,
                     const World& world, const Vector3d& push) {
  if (dt <= Duration::zero()) return;
  const Vector3d air = wind.allFinite() ? wind : Vector3d::Zero();
  const auto steps = static_cast<int>(std::ceil(to_seconds(dt) / kLongestStep - 1e-9));
  const Time begin = truth_.time;
  for (int i = 0; i < steps; ++i) {
    substep(to_seconds(dt) / steps, thrust_commands, air, world, push);
    truth_.time = begin + dt * (i + 1) / steps;
  }
}

Vector4d Quadrotor::lag_rotors(double dt, const Vector4d& commands) {
  const QuadrotorModel& model = params_.model;
  const double tau = model.rotor_time_constant;
  const double decay = tau > 0.0 ? std::exp(-dt / tau) : 0.0;
  Vector4d mean;
  for (int i = 0; i < 4; ++i) {
    const bool on = commands[i] > 0.0;  // false for what is not a number
    const double target =
        on ? std::clamp(commands[i], model.rotor_thrust_min, model.rotor_thrust_max) : 0.0;
    const double away = truth_.rotor_thrusts[i] - target;
    mean[i] = target + (tau > 0.0 ? away * (1.0 - decay) * tau / dt : 0.0);
    truth_.rotor_thrusts[i] = target + away * decay;
  }
  return mean;
}

void Quadrotor::substep(double dt, const Vector4d& commands, const Vector3d& wind,
                        const World& world, const Vector3d& push) {
  // Equation 2: rotor thrusts to collective thrust and moments.
  const Vector4d wrench = allocation_ * lag_rotors(dt, commands);
  const ContactWrench ground = ground_.step(truth_.body, world, dt);
  hull_.watch_clearance(!ground.is_near);
  const ContactWrench hull = hull_.step(truth_.time, truth_.body, world);
  const Loads loads{wrench[0], wrench.tail<3>() + ground.moment_B + hull.moment_B,
                    ground.force_W + hull.force_W + push, wind};

  const RigidBodyState before = truth_.body;
  RigidBodyState after = runge_kutta(before, params_, loads, dt);
  limit(after.v_WB_W, kSpeedLimit);
  limit(after.w_WB_B, kRateLimit);
  after.p_WB = after.p_WB.cwiseMax(-kPositionLimit).cwiseMin(kPositionLimit);
  if (!is_finite(after)) {
    after = before;
    after.v_WB_W.setZero();
    after.w_WB_B.setZero();
  }

  truth_.body = after;
  truth_.on_ground = ground.touches;
  const Vector3d gravity(0.0, 0.0, -kGravity);
  truth_.specific_force = after.q_WB.conjugate() * ((after.v_WB_W - before.v_WB_W) / dt - gravity);
  truth_.angular_acceleration = (after.w_WB_B - before.w_WB_B) / dt;
}

}  // namespace swiftlet
