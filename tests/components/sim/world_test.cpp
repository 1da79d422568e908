// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/world.hpp"

#include <limits>
#include <random>

#include "tests/components/sim/fixture.hpp"

namespace swiftlet {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Isometry3d random_pose(std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  Isometry3d T = Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(u(random), u(random), u(random), u(random) + 1.5)
                   .normalized()
                   .toRotationMatrix();
  T.translation() << 3.0 * u(random), 3.0 * u(random), 3.0 * u(random);
  return T;
}

Shape make(Shape::Kind kind, const Isometry3d& T_WS) {
  Shape shape;
  shape.model = "solid";
  shape.kind = kind;
  shape.T_WS = T_WS;
  shape.half_size = {0.7, 0.4, 1.1};
  shape.radius = 0.6;
  shape.half_length = 0.9;
  return shape;
}

/// Independent of the code under test: signed "inside" functions of the solids, in their frame.
bool is_inside(const Shape& shape, const Vector3d& p_W) {
  const Vector3d p = shape.T_WS.inverse() * p_W;
  switch (shape.kind) {
    case Shape::Kind::kBox:
      return (p.cwiseAbs() - shape.half_size).maxCoeff() < 0.0;
    case Shape::Kind::kSphere:
      return p.norm() < shape.radius;
    case Shape::Kind::kCylinder:
      return std::hypot(p.x(), p.y()) < shape.radius && std::abs(p.z()) < shape.half_length;
    default:
      return p.z() < 0.0;
  }
}

/// The first change of inside and outside along a ray, by marching and bisection.
double march(const Shape& shape, const Vector3d& o, const Vector3d& d, double max_range) {
  constexpr double kStep = 2e-3;
  const bool begin = is_inside(shape, o);
  for (double t = kStep; t <= max_range; t += kStep) {
    if (is_inside(shape, o + t * d) == begin) continue;
    double low = t - kStep;
    double high = t;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (is_inside(shape, o + middle * d) == begin ? low : high) = middle;
    }
    return high;
  }
  return kInfinity;
}

class EachSolid : public testing::TestWithParam<Shape::Kind> {};
INSTANTIATE_TEST_SUITE_P(World, EachSolid,
                         testing::Values(Shape::Kind::kBox, Shape::Kind::kCylinder,
                                         Shape::Kind::kSphere, Shape::Kind::kPlane));

TEST_P(EachSolid, RaysMeetItWhereMarchingAlongThemDoes) {
  std::mt19937 random(4);
  std::normal_distribution<double> n;
  int hits = 0;
  for (int round = 0; round < 20; ++round) {
    const Shape shape = make(GetParam(), random_pose(random));
    World world;
    world.add(shape);
    const Vector3d origin(2.0 * n(random), 2.0 * n(random), 2.0 * n(random));
    Eigen::Matrix3Xd directions(3, 13);  // not a multiple of the packet size
    for (int i = 0; i < directions.cols(); ++i) {
      const Vector3d target =
          shape.T_WS.translation() + 0.5 * Vector3d(n(random), n(random), n(random));
      directions.col(i) = (target - origin).normalized();
    }
    std::vector<double> ranges;
    world.cast_rays(origin, directions, 12.0, ranges);
    ASSERT_EQ(ranges.size(), 13U);
    for (int i = 0; i < directions.cols(); ++i) {
      const double expected = march(shape, origin, directions.col(i), 12.0);
      if (std::isfinite(expected)) {
        ++hits;
        EXPECT_NEAR(ranges[i], expected, 2e-5);
      } else {
        // A ray that only grazes can be missed by marching, never by more than a sliver.
        if (std::isfinite(ranges[i])) {
          const Vector3d behind = origin + (ranges[i] + 4e-3) * directions.col(i);
          EXPECT_FALSE(is_inside(shape, behind));
        }
      }
      const auto single = world.cast_ray(origin, directions.col(i), 12.0);
      ASSERT_EQ(single.has_value(), std::isfinite(ranges[i]));
      if (single) {
        EXPECT_NEAR(single->range, ranges[i], 1e-5);
        EXPECT_EQ(single->model, "solid");
        EXPECT_LE(single->normal.dot(directions.col(i)), 0.0);
        EXPECT_NEAR(single->normal.norm(), 1.0, 1e-5);
      }
    }
  }
  EXPECT_GT(hits, 80);
}

TEST_P(EachSolid, DistanceIsSignedAndItsPointIsTheNearestOfTheSurface) {
  std::mt19937 random(5);
  std::normal_distribution<double> n;
  int inside = 0;
  for (int round = 0; round < 300; ++round) {
    const Shape shape = make(GetParam(), random_pose(random));
    World world;
    world.add(shape);
    const Vector3d p = shape.T_WS.translation() + 0.8 * Vector3d(n(random), n(random), n(random));
    const auto nearest = world.nearest(p, 100.0);
    ASSERT_TRUE(nearest.has_value());
    EXPECT_EQ(nearest->distance < 0.0, is_inside(shape, p));
    inside += nearest->distance < 0.0;
    EXPECT_NEAR((p - nearest->point).norm(), std::abs(nearest->distance), 1e-9);
    // Along the gradient the distance grows as far as one walks.
    EXPECT_NEAR(nearest->normal.norm(), 1.0, 1e-9);
    EXPECT_NEAR((p - nearest->point - nearest->distance * nearest->normal).norm(), 0.0, 1e-9);
    // The point is on the surface: just off it, one is out; no ball of that radius crosses it.
    EXPECT_FALSE(is_inside(shape, nearest->point + 1e-6 * nearest->normal));
    for (int i = 0; i < 50; ++i) {
      const Vector3d way = Vector3d(n(random), n(random), n(random)).normalized();
      const Vector3d q = p + 0.999 * std::abs(nearest->distance) * way;
      EXPECT_EQ(is_inside(shape, q), is_inside(shape, p));
    }
  }
  EXPECT_GT(inside, 20);
}

Shape tetrahedron() {
  Shape mesh;
  mesh.model = "mesh";
  mesh.kind = Shape::Kind::kMesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  mesh.T_WS.translation() << 2.0, 0.0, 0.0;
  return mesh;
}

TEST(World, MeshesAreMetAndMeasuredByTheirTriangles) {
  World world;
  world.add(tetrahedron());
  // The face x + y + z = 1 of the corner at (2, 0, 0).
  const auto hit = world.cast_ray({5.0, 0.2, 0.3}, -Vector3d::UnitX(), 10.0);
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(hit->range, 2.5, 1e-6);
  EXPECT_NEAR((hit->normal - Vector3d(1, 1, 1).normalized()).norm(), 0.0, 1e-6);
  const Vector3d p(3.0, 1.0, 1.0);
  const auto nearest = world.nearest(p, 10.0);
  ASSERT_TRUE(nearest.has_value());
  EXPECT_NEAR(nearest->distance, 2.0 / std::sqrt(3.0), 1e-9);
  EXPECT_EQ(nearest->model, "mesh");
  // Distances beside an edge and beside a corner.
  EXPECT_NEAR(world.nearest({2.5, -3.0, -4.0}, 10.0)->distance, 5.0, 1e-9);
  EXPECT_NEAR(world.nearest({2.0, 0.0, 3.0}, 10.0)->distance, 2.0, 1e-9);
}

TEST(World, TheNearestOfManyIsThatOfBruteForce) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  World world;
  for (int i = 0; i < 60; ++i) {
    Shape shape = make(i % 2 ? Shape::Kind::kBox : Shape::Kind::kCylinder, random_pose(random));
    shape.T_WS.translation() *= 4.0;
    shape.model = "solid_" + std::to_string(i);
    world.add(shape);
  }
  for (int round = 0; round < 300; ++round) {
    const Vector3d p(12.0 * u(random), 12.0 * u(random), 12.0 * u(random));
    double expected = kInfinity;
    std::string model;
    for (const Shape* shape : world.shapes()) {
      const double distance = surface_distance(*shape, p).distance;
      if (distance < expected) expected = distance, model = shape->model;
    }
    const auto nearest = world.nearest(p, 100.0);
    ASSERT_TRUE(nearest.has_value());
    EXPECT_EQ(nearest->distance, expected);
    EXPECT_EQ(nearest->model, model);
    EXPECT_EQ(world.nearest(p, expected - 0.01).has_value(), expected < 0.0 && expected > 0.01);
  }
}

TEST(World, ShapesComeAndGoByName) {
  World world = test::flat_world();
  Isometry3d T = Isometry3d::Identity();
  T.translation() << 3.0, 0.0, 1.0;
  const Vector3d eye(0.0, 0.0, 1.0);
  EXPECT_FALSE(world.cast_ray(eye, Vector3d::UnitX(), 20.0));
  const auto before = world.revision();
  world.add_box("door", T, {0.1, 1.0, 2.0});
  EXPECT_GT(world.revision(), before);
  EXPECT_NEAR(world.cast_ray(eye, Vector3d::UnitX(), 20.0)->range, 2.95, 1e-6);
  EXPECT_EQ(world.nearest(eye, 20.0, World::Surfaces::kObstacles)->model, "door");
  EXPECT_EQ(world.nearest(eye, 20.0, World::Surfaces::kAll)->model, "floor");
  EXPECT_FALSE(world.remove("window"));
  EXPECT_TRUE(world.remove("door"));
  EXPECT_FALSE(world.remove("door"));
  EXPECT_FALSE(world.cast_ray(eye, Vector3d::UnitX(), 20.0));
  EXPECT_FALSE(world.nearest(eye, 20.0, World::Surfaces::kObstacles));
}

TEST(World, GroundIsPlanesAndWhatIsNamedSo) {
  World world = test::flat_world();
  Shape pad = make(Shape::Kind::kBox, Isometry3d::Identity());
  pad.half_size = {0.5, 0.5, 0.02};
  pad.is_ground = true;
  world.add(pad);
  EXPECT_NEAR(*world.ground_height(0.2, 0.2), 0.02, 1e-9);
  EXPECT_NEAR(*world.ground_height(2.0, 0.2), 0.0, 1e-9);
  EXPECT_NEAR(world.nearest({0, 0, 1}, 10.0, World::Surfaces::kGround)->distance, 0.98, 1e-12);
  EXPECT_FALSE(world.nearest({0, 0, 1}, 10.0, World::Surfaces::kObstacles));
  EXPECT_FALSE(World().ground_height(0.0, 0.0));
}

TEST(World, NothingThatIsNotFiniteComesOutOrGoesIn) {
  World world = test::flat_world();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> ranges;
  Eigen::Matrix3Xd directions(3, 3);
  directions << 0, nan, 0, 0, 0, 0, -1, 0, 0;
  world.cast_rays({0, 0, 1}, directions, 5.0, ranges);
  EXPECT_EQ(ranges, (std::vector<double>{1.0, kInfinity, kInfinity}));
  world.cast_rays({0, nan, 1}, directions, 5.0, ranges);
  EXPECT_EQ(ranges, std::vector<double>(3, kInfinity));
  EXPECT_FALSE(world.cast_ray({nan, 0, 1}, -Vector3d::UnitZ(), 5.0));
  EXPECT_FALSE(world.nearest({nan, 0, 1}, 5.0));
  EXPECT_FALSE(world.nearest({0, 0, 1}, nan));
  EXPECT_THAT(test::config_error([&] {
                world.add_box("door", Isometry3d::Identity(), {1.0, -2.0, 1.0});
              }),
              testing::AllOf(testing::HasSubstr("door"), testing::HasSubstr("-2 m"),
                             testing::HasSubstr("positive")));
  Isometry3d T = Isometry3d::Identity();
  T.translation().x() = nan;
  EXPECT_THAT(test::config_error([&] {
                world.add_box("door", T, {1, 1, 1});
              }),
              testing::HasSubstr("not finite"));
}

TEST(World, SlicesAreTheOutlinesAtAHeight) {
  World world = test::flat_world();
  Isometry3d T = Isometry3d::Identity();
  T.translation() << 1.0, 2.0, 0.5;
  world.add_box("desk", T, {2.0, 1.0, 1.0});
  Shape pillar = make(Shape::Kind::kCylinder, T);
  pillar.model = "pillar";
  world.add(pillar);
  const auto area = [](const std::vector<Eigen::Vector2d>& polygon) {
    double twice = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const auto& a = polygon[i];
      const auto& b = polygon[(i + 1) % polygon.size()];
      twice += a.x() * b.y() - a.y() * b.x();
    }
    return 0.5 * twice;
  };
  const auto outlines = world.slice(0.7);
  ASSERT_EQ(outlines.size(), 2U);
  EXPECT_EQ(outlines[0].model, "desk");
  EXPECT_NEAR(area(outlines[0].points), 2.0, 1e-9);
  EXPECT_NEAR(area(outlines[1].points), M_PI * 0.36, 0.01);
  EXPECT_EQ(world.slice(1.2).size(), 1U);
  EXPECT_TRUE(world.slice(3.0).empty());
}

}  // namespace
}  // namespace swiftlet
