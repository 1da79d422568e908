// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace swiftlet {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Each of the following works in the frame of the shape.

RayCrossing ray_plane(const Vector3d& o, const Vector3d& d, double t_min, double t_max) {
  const double t = -o.z() / d.z();
  const bool meets = t >= t_min && t <= t_max;  // false for the NaN and infinity of d.z() = 0
  return {meets ? t : kInfinity, Vector3d::UnitZ()};
}

RayCrossing ray_box(const Vector3d& h, const Vector3d& o, const Vector3d& d, double t_min,
                    double t_max) {
  double enter = -kInfinity;
  double leave = kInfinity;
  int enter_axis = 0;
  int leave_axis = 0;
  for (int i = 0; i < 3; ++i) {
    if (d[i] == 0.0) {
      if (std::abs(o[i]) > h[i]) return {kInfinity, Vector3d::Zero()};
      continue;
    }
    const double side = d[i] > 0.0 ? h[i] : -h[i];
    const double near = (-side - o[i]) / d[i];
    const double far = (side - o[i]) / d[i];
    if (near > enter) enter = near, enter_axis = i;
    if (far < leave) leave = far, leave_axis = i;
  }
  if (enter > leave) return {kInfinity, Vector3d::Zero()};
  const bool from_outside = enter >= t_min;
  const double t = from_outside ? enter : leave;
  if (!(t >= t_min && t <= t_max)) return {kInfinity, Vector3d::Zero()};
  return {t, Vector3d::Unit(from_outside ? enter_axis : leave_axis)};
}

RayCrossing ray_sphere(double radius, const Vector3d& o, const Vector3d& d, double t_min,
                       double t_max) {
  const double a = d.squaredNorm();
  const double b = o.dot(d);
  const double discriminant = b * b - a * (o.squaredNorm() - radius * radius);
  if (!(discriminant >= 0.0) || a == 0.0) return {kInfinity, Vector3d::Zero()};
  const double root = std::sqrt(discriminant);
  for (const double t : {(-b - root) / a, (-b + root) / a}) {
    if (t >= t_min && t <= t_max) return {t, (o + t * d) / radius};
  }
  return {kInfinity, Vector3d::Zero()};
}

RayCrossing ray_cylinder(double radius, double half_length, const Vector3d& o, const Vector3d& d,
                         double t_min, double t_max) {
  RayCrossing best{kInfinity, Vector3d::Zero()};
  const auto consider = [&](double t, const Vector3d& normal) {
    if (t >= t_min && t <= t_max && t < best.t) best = {t, normal};
  };
  const double a = d.head<2>().squaredNorm();
  const double b = o.head<2>().dot(d.head<2>());
  const double discriminant = b * b - a * (o.head<2>().squaredNorm() - radius * radius);
  if (a > 0.0 && discriminant >= 0.0) {
    const double root = std::sqrt(discriminant);
    for (const double t : {(-b - root) / a, (-b + root) / a}) {
      const Vector3d p = o + t * d;
      if (std::abs(p.z()) <= half_length) consider(t, {p.x() / radius, p.y() / radius, 0.0});
    }
  }
  for (const double cap : {-half_length, half_length}) {
    if (d.z() == 0.0) continue;
    const double t = (cap - o.z()) / d.z();
    if ((o + t * d).head<2>().squaredNorm() <= radius * radius) consider(t, Vector3d::UnitZ());
  }
  return best;
}

SurfaceDistance distance_box(const Vector3d& h, const Vector3d& p) {
  const Vector3d nearest = p.cwiseMax(-h).cwiseMin(h);
  const Vector3d away = p - nearest;
  const double distance = away.norm();
  if (distance > 0.0) return {distance, nearest, away / distance};
  int axis = 0;
  const double depth = (h - p.cwiseAbs()).minCoeff(&axis);
  const double sign = p[axis] < 0.0 ? -1.0 : 1.0;
  Vector3d point = p;
  point[axis] = sign * h[axis];
  return {-depth, point, sign * Vector3d::Unit(axis)};
}

SurfaceDistance distance_sphere(double radius, const Vector3d& p) {
  const double r = p.norm();
  const Vector3d normal = r > 0.0 ? Vector3d(p / r) : Vector3d::UnitZ();
  return {r - radius, radius * normal, normal};
}

/// A cylinder is a box in the coordinates (distance from the axis, height).
SurfaceDistance distance_cylinder(double radius, double half_length, const Vector3d& p) {
  const double r = p.head<2>().norm();
  const Vector3d outward =
      r > 0.0 ? Vector3d(p.x() / r, p.y() / r, 0.0) : Vector3d(Vector3d::UnitX());
  const Vector2d q(r, p.z());
  const Vector2d nearest(std::min(r, radius), std::clamp(p.z(), -half_length, half_length));
  const auto lift = [&](const Vector2d& v) -> Vector3d {
    return v.x() * outward + v.y() * Vector3d::UnitZ();
  };
  const double distance = (q - nearest).norm();
  if (distance > 0.0) return {distance, lift(nearest), lift((q - nearest) / distance)};
  const double to_side = radius - r;
  const double to_cap = half_length - std::abs(p.z());
  if (to_side < to_cap) return {-to_side, lift({radius, p.z()}), outward};
  const double sign = p.z() < 0.0 ? -1.0 : 1.0;
  return {-to_cap, lift({r, sign * half_length}), sign * Vector3d::UnitZ()};
}

/// Nearest point of the triangle abc, by the Voronoi regions of its corners and edges
/// (C. Ericson, Real-Time Collision Detection, 5.1.5).
Vector3d nearest_on_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                             const Vector3d& c) {
  const Vector3d ab = b - a;
  const Vector3d ac = c - a;
  const double d1 = ab.dot(p - a);
  const double d2 = ac.dot(p - a);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const double d3 = ab.dot(p - b);
  const double d4 = ac.dot(p - b);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
  const double d5 = ab.dot(p - c);
  const double d6 = ac.dot(p - c);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  }
  const double sum = va + vb + vc;
  return a + vb / sum * ab + vc / sum * ac;
}

bool positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

}  // namespace

std::string fault_of(const Shape& shape) {
  if (!shape.T_WS.matrix().allFinite()) return "its pose is not finite; give finite numbers";
  switch (shape.kind) {
    case Shape::Kind::kPlane:
      return "";
    case Shape::Kind::kBox:
      for (const double half : shape.half_size) {
        if (!positive(half)) {
          return fmt::format("a side of its box is {} m; give a positive length", 2.0 * half);
        }
      }
      return "";
    case Shape::Kind::kCylinder:
      if (!positive(shape.half_length)) {
        return fmt::format("the length of its cylinder is {} m; give a positive one",
                           2.0 * shape.half_length);
      }
      [[fallthrough]];
    case Shape::Kind::kSphere:
      if (positive(shape.radius)) return "";
      return fmt::format("its radius is {} m; give a positive one", shape.radius);
    case Shape::Kind::kMesh:
      if (shape.triangles.empty()) return "its mesh has no triangles";
      if (shape.is_ground) return "a mesh cannot be ground; use a plane, box or cylinder";
      for (const Vector3d& vertex : shape.vertices) {
        if (!vertex.allFinite()) return "its mesh has a vertex that is not finite";
      }
      for (const auto& triangle : shape.triangles) {
        for (const std::uint32_t corner : triangle) {
          if (corner >= shape.vertices.size()) return "its mesh has a triangle without vertex";
        }
      }
      return "";
  }
  return "";
}

RayCrossing intersect(const Shape& shape, const Vector3d& origin, const Vector3d& direction,
                      double t_min, double t_max) {
  const Vector3d o = shape.T_WS.linear().transpose() * (origin - shape.T_WS.translation());
  const Vector3d d = shape.T_WS.linear().transpose() * direction;
  RayCrossing crossing{kInfinity, Vector3d::Zero()};
  switch (shape.kind) {
    case Shape::Kind::kPlane:
      crossing = ray_plane(o, d, t_min, t_max);
      break;
    case Shape::Kind::kBox:
      crossing = ray_box(shape.half_size, o, d, t_min, t_max);
      break;
    case Shape::Kind::kCylinder:
      crossing = ray_cylinder(shape.radius, shape.half_length, o, d, t_min, t_max);
      break;
    case Shape::Kind::kSphere:
      crossing = ray_sphere(shape.radius, o, d, t_min, t_max);
      break;
    case Shape::Kind::kMesh:
      break;
  }
  return {crossing.t, shape.T_WS.linear() * crossing.normal};
}

SurfaceDistance surface_distance(const Shape& shape, const Vector3d& point) {
  const Vector3d p = shape.T_WS.linear().transpose() * (point - shape.T_WS.translation());
  SurfaceDistance local{kInfinity, p, Vector3d::UnitZ()};
  switch (shape.kind) {
    case Shape::Kind::kPlane:
      local = {p.z(), Vector3d(p.x(), p.y(), 0.0), Vector3d::UnitZ()};
      break;
    case Shape::Kind::kBox:
      local = distance_box(shape.half_size, p);
      break;
    case Shape::Kind::kCylinder:
      local = distance_cylinder(shape.radius, shape.half_length, p);
      break;
    case Shape::Kind::kSphere:
      local = distance_sphere(shape.radius, p);
      break;
    case Shape::Kind::kMesh: {
      SurfaceDistance best = local;
      for (std::size_t i = 0; i < shape.triangles.size(); ++i) {
        const SurfaceDistance candidate = triangle_distance(shape, i, point);
        if (candidate.distance < best.distance) best = candidate;
      }
      return best;
    }
  }
  return {local.distance, shape.T_WS * local.point, shape.T_WS.linear() * local.normal};
}

SurfaceDistance triangle_distance(const Shape& mesh, std::size_t triangle, const Vector3d& point) {
  const auto& corners = mesh.triangles[triangle];
  const Vector3d a = mesh.T_WS * mesh.vertices[corners[0]];
  const Vector3d b = mesh.T_WS * mesh.vertices[corners[1]];
  const Vector3d c = mesh.T_WS * mesh.vertices[corners[2]];
  const Vector3d nearest = nearest_on_triangle(point, a, b, c);
  const Vector3d away = point - nearest;
  const double distance = away.norm();
  if (distance > 0.0) return {distance, nearest, away / distance};
  const Vector3d face = (b - a).cross(c - a);
  return {0.0, nearest, face.norm() > 0.0 ? Vector3d(face.normalized()) : Vector3d::UnitZ()};
}

Eigen::AlignedBox3d bounds(const Shape& shape) {
  const Eigen::Matrix3d R = shape.T_WS.linear();
  Eigen::AlignedBox3d box;
  Vector3d half = Vector3d::Zero();
  switch (shape.kind) {
    case Shape::Kind::kPlane:
      return box;
    case Shape::Kind::kBox:
      half = R.cwiseAbs() * shape.half_size;
      break;
    case Shape::Kind::kCylinder:
      // A disc with the axis z_W,i reaches radius * sqrt(1 - z_i^2) along axis i.
      for (int i = 0; i < 3; ++i) {
        half[i] = shape.half_length * std::abs(R(i, 2)) +
                  shape.radius * std::sqrt(std::max(0.0, 1.0 - R(i, 2) * R(i, 2)));
      }
      break;
    case Shape::Kind::kSphere:
      half.setConstant(shape.radius);
      break;
    case Shape::Kind::kMesh:
      for (const Vector3d& vertex : shape.vertices) box.extend(shape.T_WS * vertex);
      return box;
  }
  box.extend(shape.T_WS.translation() - half);
  box.extend(shape.T_WS.translation() + half);
  return box;
}

}  // namespace swiftlet
