// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/sim/shape.hpp"
#include "estimation/geodesy/local_origin.hpp"

namespace swiftlet {

/// The solid surroundings of the vehicle, for rays and for distances.
///
/// Frame W is ENU, as in the world file. Everything stands still; shapes come and go by the name
/// of their model. Queries are const and may run in several threads.
class World {
 public:
  /// Which surfaces a distance is measured to. Ground may be landed on, obstacles may not be
  /// touched.
  enum class Surfaces { kAll, kGround, kObstacles };

  /// An empty world.
  World();
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Reads an SDFormat file (as Gazebo has them): the collisions of all models, which are taken
  /// as static: planes, boxes, cylinders, spheres and meshes (.obj, .stl, .dae), poses with
  /// `relative_to`, nested models, and `<include>` of model folders beside the file or in `models`
  /// beside it. Planes are ground, and so are all models named in `ground_models`.
  /// Throws ConfigError with file, line and element.
  static World load(const std::filesystem::path& file,
                    const std::vector<std::string>& ground_models = {});

  /// Adds one shape. Throws ConfigError where a length or pose is not finite or not positive.
  void add(Shape shape);
  void add_box(const std::string& model, const Eigen::Isometry3d& T_WS,
               const Eigen::Vector3d& size);
  /// Removes all shapes of `model`, and tells whether there were any.
  bool remove(const std::string& model);
  /// Where on Earth the world's origin is, if its file says so (`<spherical_coordinates>`).
  const std::optional<LocalOrigin>& local_origin() const { return local_origin_; }

  /// Counts up with every change of the shapes.
  std::uint64_t revision() const;

  /// Shapes of the world, in the order in which they were added.
  std::vector<const Shape*> shapes() const;

  /// Ranges [m] along `directions` (3 x n unit vectors in W) from `origin` to the first surface,
  /// infinity where there is none within `max_range` [m]. `ranges` is resized to n. An origin or
  /// direction that is not finite gives infinity.
  void cast_rays(const Eigen::Vector3d& origin, const Eigen::Matrix3Xd& directions,
                 double max_range, std::vector<double>& ranges) const;
  struct RayHit {
    double range;            ///< [m]
    Eigen::Vector3d normal;  ///< of the surface, unit length, towards the origin of the ray
    std::string_view model;  ///< valid until the model is removed
  };
  std::optional<RayHit> cast_ray(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                 double max_range) const;

  struct Nearest : SurfaceDistance {
    std::string_view model;  ///< valid until the model is removed
  };
  /// The surface nearest to `point`, none where all are further than `max_distance` [m]. Inside
  /// of a solid the distance is negative.
  std::optional<Nearest> nearest(const Eigen::Vector3d& point, double max_distance,
                                 Surfaces surfaces = Surfaces::kAll) const;

  /// Height [m] of the uppermost ground above or below (x, y), none where there is no ground.
  std::optional<double> ground_height(double x, double y) const;

  /// Horizontal cut through all shapes but planes at `height` [m], for plan views.
  std::vector<Outline> slice(double height) const;

 private:
  std::optional<LocalOrigin> local_origin_;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace swiftlet
