// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace swiftlet {

/// One solid of the world. Lengths in metres; T_WS takes the shape's frame to the world.
struct Shape {
  enum class Kind {
    kPlane,     ///< the half-space below the xy plane of S, infinite as in SDFormat
    kBox,       ///< centred, `half_size`
    kCylinder,  ///< centred, along z, `radius` and `half_length`
    kSphere,    ///< centred, `radius`
    kMesh,      ///< triangles; a surface without an inside
  };
  std::string model;       ///< name of the model that it belongs to
  bool is_ground = false;  ///< may be landed on: touching it is no collision
  Kind kind = Kind::kBox;
  Eigen::Isometry3d T_WS = Eigen::Isometry3d::Identity();
  Eigen::Vector3d half_size = Eigen::Vector3d::Zero();
  double radius = 0.0;
  double half_length = 0.0;
  std::vector<Eigen::Vector3d> vertices;                ///< of a mesh, in S
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of a mesh, into `vertices`
};

/// What makes the shape unusable and what to do about it, "" for nothing: numbers that are not
/// finite, lengths that are not positive, a mesh without triangles or as ground.
std::string fault_of(const Shape& shape);

/// Where a ray meets a shape: `t` is infinite where it does not.
struct RayCrossing {
  double t;
  Eigen::Vector3d normal;  ///< of the surface in the world, unit length, not towards any side
};

/// The first crossing of the ray origin + t * direction (world) with t in [t_min, t_max]. A ray
/// that starts inside meets the surface on its way out. Not for meshes.
RayCrossing intersect(const Shape& shape, const Eigen::Vector3d& origin,
                      const Eigen::Vector3d& direction, double t_min, double t_max);

/// The place on the surface that is nearest to a point.
struct SurfaceDistance {
  double distance;         ///< [m], negative inside a solid
  Eigen::Vector3d point;   ///< on the surface, in the world
  Eigen::Vector3d normal;  ///< unit vector away from the solid, the gradient of the distance
};
SurfaceDistance surface_distance(const Shape& shape, const Eigen::Vector3d& point);
/// The same for one triangle of a mesh; never negative.
SurfaceDistance triangle_distance(const Shape& mesh, std::size_t triangle,
                                  const Eigen::Vector3d& point);

/// Axis-aligned box around the shape in the world. Not for planes.
Eigen::AlignedBox3d bounds(const Shape& shape);

/// Cut of a shape with a horizontal plane, in the world.
struct Outline {
  std::string model;
  bool is_ground = false;
  bool is_closed = true;                ///< a filled polygon; else a line (of a mesh)
  std::vector<Eigen::Vector2d> points;  ///< [m], counter-clockwise where closed
};
/// Adds the cut of `shape` at `height` [m] to `outlines`; nothing where it does not reach there.
void slice(const Shape& shape, double height, std::vector<Outline>& outlines);

}  // namespace swiftlet
