// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "components/sim/shape.hpp"

namespace swiftlet {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Corners and edges of a convex polyhedron that is, or stands for, the shape.
struct Hull {
  std::vector<Vector3d> corners;
  std::vector<std::array<std::size_t, 2>> edges;
};

Hull box_hull(const Vector3d& h) {
  Hull hull;
  for (int i = 0; i < 8; ++i) {
    hull.corners.emplace_back((i & 1 ? 1 : -1) * h.x(), (i & 2 ? 1 : -1) * h.y(),
                              (i & 4 ? 1 : -1) * h.z());
    for (const int bit : {1, 2, 4}) {
      if (!(i & bit)) hull.edges.push_back({std::size_t(i), std::size_t(i | bit)});
    }
  }
  return hull;
}

constexpr int kCircleSegments = 48;

Hull cylinder_hull(double radius, double half_length) {
  Hull hull;
  for (std::size_t i = 0; i < kCircleSegments; ++i) {
    const double angle = 2.0 * M_PI * static_cast<double>(i) / kCircleSegments;
    for (const double z : {-half_length, half_length}) {
      hull.corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
    const std::size_t next = (i + 1) % kCircleSegments;
    hull.edges.push_back({2 * i, 2 * i + 1});
    hull.edges.push_back({2 * i, 2 * next});
    hull.edges.push_back({2 * i + 1, 2 * next + 1});
  }
  return hull;
}

/// Where the edge from a to b crosses `height`.
bool crossing(const Vector3d& a, const Vector3d& b, double height, Vector2d& point) {
  if ((a.z() < height) == (b.z() < height)) return false;
  const double s = (height - a.z()) / (b.z() - a.z());
  point = (a + s * (b - a)).head<2>();
  return true;
}

/// The convex polygon in which the hull crosses `height`: its corners, sorted by their angle.
std::vector<Vector2d> cut(const Hull& hull, const Eigen::Isometry3d& T_WS, double height) {
  std::vector<Vector2d> points;
  Vector2d centre = Vector2d::Zero();
  for (const auto& edge : hull.edges) {
    Vector2d p;
    if (crossing(T_WS * hull.corners[edge[0]], T_WS * hull.corners[edge[1]], height, p)) {
      points.push_back(p);
      centre += p;
    }
  }
  if (points.size() < 3) return {};
  centre /= static_cast<double>(points.size());
  const auto angle = [&](const Vector2d& p) {
    return std::atan2(p.y() - centre.y(), p.x() - centre.x());
  };
  std::sort(points.begin(), points.end(),
            [&](const Vector2d& a, const Vector2d& b) { return angle(a) < angle(b); });
  return points;
}

std::vector<Vector2d> circle(const Vector2d& centre, double radius) {
  std::vector<Vector2d> points;
  for (int i = 0; i < kCircleSegments; ++i) {
    const double angle = 2.0 * M_PI * i / kCircleSegments;
    points.push_back(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

void slice_mesh(const Shape& mesh, double height, std::vector<Outline>& outlines) {
  for (const auto& triangle : mesh.triangles) {
    std::vector<Vector2d> ends;
    for (int i = 0; i < 3; ++i) {
      Vector2d p;
      if (crossing(mesh.T_WS * mesh.vertices[triangle[i]],
                   mesh.T_WS * mesh.vertices[triangle[(i + 1) % 3]], height, p)) {
        ends.push_back(p);
      }
    }
    if (ends.size() == 2) outlines.push_back({mesh.model, mesh.is_ground, false, ends});
  }
}

}  // namespace

void slice(const Shape& shape, double height, std::vector<Outline>& outlines) {
  std::vector<Vector2d> polygon;
  switch (shape.kind) {
    case Shape::Kind::kPlane:
      return;
    case Shape::Kind::kMesh:
      return slice_mesh(shape, height, outlines);
    case Shape::Kind::kBox:
      polygon = cut(box_hull(shape.half_size), shape.T_WS, height);
      break;
    case Shape::Kind::kCylinder:
      polygon = cut(cylinder_hull(shape.radius, shape.half_length), shape.T_WS, height);
      break;
    case Shape::Kind::kSphere: {
      const double z = height - shape.T_WS.translation().z();
      const double squared = shape.radius * shape.radius - z * z;
      if (squared > 0.0) {
        polygon = circle(shape.T_WS.translation().head<2>(), std::sqrt(squared));
      }
      break;
    }
  }
  if (!polygon.empty()) outlines.push_back({shape.model, shape.is_ground, true, polygon});
}

}  // namespace swiftlet
