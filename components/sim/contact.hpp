// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "components/sim/world.hpp"
#include "control/quadrotor_model.hpp"
#include "estimation/basics/time.hpp"
#include "estimation/geometry/rigid_body.hpp"

namespace swiftlet {

/// What touching things does to the body during one step.
struct ContactWrench {
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d moment_B = Eigen::Vector3d::Zero();  ///< about the centre of mass [N m]
  bool touches = false;
  bool is_near = false;  ///< touches, or nearly so: not what one would call flying
};

/// Springs and dampers of everything that can touch something. The stiffness follows from mass and
/// inertia, so that every vehicle is as stiff as the time step allows and none is unstable.
struct ContactParams {
  double natural_frequency = 100.0;  ///< of the body on its springs [rad/s]; steps of 1 ms bear 300
  double damping_ratio = 0.6;        ///< [1]
  double friction = 0.8;             ///< Coulomb's coefficient [1]
};

/// The vehicle standing on the ground: four feet, and the rotor hubs and mast for the vehicle that
/// has turned over. Each point is a spring and damper along the normal; along the ground it is a
/// bristle (a spring that slips where Coulomb friction ends), so that a vehicle at rest does not
/// creep.
class GroundContact {
 public:
  struct Params : ContactParams {
    double leg_height = 0.12;  ///< feet below the centre of mass [m]
    double leg_spread = 0.15;  ///< feet from the vertical axis, along the diagonals [m]
    double mast_height = 0.1;  ///< top of the vehicle above the centre of mass [m]
  };
  GroundContact(const Params& params, const QuadrotorModel& model);

  ContactWrench step(const RigidBodyState& body, const World& world, double dt);
  void reset();

 private:
  struct Point {
    Eigen::Vector3d p_BP;                               ///< in the body [m]
    Eigen::Vector3d bristle = Eigen::Vector3d::Zero();  ///< its deflection, in the world [m]
  };
  Params params_;
  std::vector<Point> points_;
  double reach_;      ///< of the furthest point [m]
  double stiffness_;  ///< of one point [N/m]
  double damping_;    ///< of one point [N s/m]
};

/// One collision: the moment at which the hull began to touch an obstacle.
struct Collision {
  Time time;
  std::string model;                                ///< what was hit
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< where, in the world [m]
  double speed = 0.0;                               ///< towards the surface [m/s]
};

/// The hull, a sphere about the centre of mass, against everything that is not ground.
class HullContact {
 public:
  struct Params : ContactParams {
    double radius = 0.25;  ///< centre of mass to the tips of the propellers [m]
  };
  HullContact(const Params& params, const QuadrotorModel& model);

  ContactWrench step(Time now, const RigidBodyState& body, const World& world);

  /// Collisions so far: their number, and what is known of the first thousand.
  int count() const { return count_; }
  const std::vector<Collision>& collisions() const { return collisions_; }
  /// Smallest distance [m] between hull and obstacles at all steps since `watch_clearance(true)`,
  /// infinite where there was none. Negative is a collision.
  double min_clearance() const { return min_clearance_; }
  void watch_clearance(bool on) { watches_clearance_ = on; }

 private:
  void note(Time now, const World::Nearest& nearest, double speed);

  Params params_;
  double mass_;
  int count_ = 0;
  std::vector<Collision> collisions_;
  std::string touched_;  ///< model in contact, "" for none
  double min_clearance_;
  bool watches_clearance_ = false;
  // Distance is 1-Lipschitz: a query answered here bounds the distance everywhere around.
  Eigen::Vector3d last_query_ = Eigen::Vector3d::Zero();
  double last_distance_ = 0.0;
  std::uint64_t last_revision_ = 0;
};

}  // namespace swiftlet
