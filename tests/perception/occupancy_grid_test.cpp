// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/occupancy_grid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kNoReturn = std::numeric_limits<float>::infinity();
constexpr float kUnreadable = std::numeric_limits<float>::quiet_NaN();

LaserScan one_beam(double angle, float range, double range_max = 12.0) {
  LaserScan scan;
  scan.angle_min = angle;
  scan.angle_increment = 0.1;
  scan.range_min = 0.1;
  scan.range_max = range_max;
  scan.ranges = {range};
  return scan;
}

ScanInsertion insert_level(OccupancyGrid& grid, const LaserScan& scan, double x, double y,
                           double yaw = 0.0) {
  const auto result = grid.insert(scan, {x, y, 1.0}, from_yaw(yaw));
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().reason);
  return result.ok() ? *result : ScanInsertion{};
}

/// Whether the segment a-b crosses the interior of the square of a cell: clipped to its four sides
/// (Liang and Barsky), with nothing in common with the traversal that is tested. How much of it is
/// inside comes back too, to leave out touching.
double length_inside(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& low,
                     double edge) {
  double t0 = 0.0, t1 = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double d = b[axis] - a[axis];
    if (d == 0.0) {
      if (a[axis] < low[axis] || a[axis] > low[axis] + edge) return 0.0;
      continue;
    }
    const double s0 = (low[axis] - a[axis]) / d, s1 = (low[axis] + edge - a[axis]) / d;
    t0 = std::max(t0, std::min(s0, s1));
    t1 = std::min(t1, std::max(s0, s1));
  }
  return t1 > t0 ? (t1 - t0) * (b - a).norm() : 0.0;
}

/// A room without a roof: distance along a ray to the nearest of some axis-aligned boxes.
struct Box {
  double x0, y0, x1, y1;
};
double cast(const std::vector<Box>& boxes, const Eigen::Vector2d& from, double angle) {
  double nearest = std::numeric_limits<double>::infinity();
  const Eigen::Vector2d d(std::cos(angle), std::sin(angle));
  for (const Box& box : boxes) {
    double t0 = 0.0, t1 = 1e9;
    const double low[] = {box.x0, box.y0}, high[] = {box.x1, box.y1};
    for (int axis = 0; axis < 2; ++axis) {
      if (std::abs(d[axis]) < 1e-12) {
        if (from[axis] < low[axis] || from[axis] > high[axis]) t1 = -1.0;
        continue;
      }
      const double a = (low[axis] - from[axis]) / d[axis], b = (high[axis] - from[axis]) / d[axis];
      t0 = std::max(t0, std::min(a, b));
      t1 = std::min(t1, std::max(a, b));
    }
    if (t0 <= t1) nearest = std::min(nearest, t0);
  }
  return nearest;
}

LaserScan scan_of(const std::vector<Box>& boxes, const Eigen::Vector2d& from, int beams) {
  LaserScan scan;
  scan.angle_min = -kPi;
  scan.angle_increment = 2 * kPi / beams;
  scan.range_min = 0.05;
  scan.range_max = 12.0;
  for (int i = 0; i < beams; ++i) {
    const double range = cast(boxes, from, scan.angle_min + i * scan.angle_increment);
    scan.ranges.push_back(range < scan.range_max ? static_cast<float>(range) : kNoReturn);
  }
  return scan;
}

TEST(OccupancyGrid, ABeamTouchesExactlyTheCellsItCrosses) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-2.0, 2.0), angle(-kPi, kPi), range(0.2, 5.0);
  for (int trial = 0; trial < 500; ++trial) {
    OccupancyGrid grid;
    const Eigen::Vector2d from(place(random), place(random));
    const double direction = angle(random);
    const auto length = static_cast<float>(range(random));
    insert_level(grid, one_beam(direction, length), from.x(), from.y());
    const Eigen::Vector2d to = from + static_cast<double>(length) *
                                          Eigen::Vector2d(std::cos(direction), std::sin(direction));
    for (int y = 0; y < grid.height(); ++y) {
      for (int x = 0; x < grid.width(); ++x) {
        const Eigen::Vector2d low = grid.center_of({x, y}) - Eigen::Vector2d::Constant(0.025);
        const double inside = length_inside(from, to, low, 0.05);
        const bool touched = grid.probability({x, y}) != 0.5;
        // Rays are traced in parts of 1/4096 of a cell: what is cut by less is left open.
        if (inside > 1e-4) {
          EXPECT_TRUE(touched) << trial << ": " << x << " " << y << " " << inside;
        }
        if (inside == 0.0 && touched) {
          const double margin =
              length_inside(from, to, low - Eigen::Vector2d::Constant(1e-4), 0.05 + 2e-4);
          EXPECT_GT(margin, 0.0) << trial << ": " << x << " " << y;
        }
      }
    }
    EXPECT_GT(grid.probability(grid.cell_of(to)), 0.5);
  }
}

TEST(OccupancyGrid, AnAxisAlignedBeamIsFreeUpToItsReturn) {
  OccupancyGrid grid;
  for (int i = 0; i < 5; ++i) insert_level(grid, one_beam(0.0, 1.02F), 0.02, 0.02);
  for (double x = 0.02; x < 1.0; x += 0.05) {
    EXPECT_EQ(grid.state(grid.cell_of({x, 0.02})), CellState::kFree) << x;
  }
  EXPECT_EQ(grid.state(grid.cell_of({1.04, 0.02})), CellState::kOccupied);
  EXPECT_EQ(grid.state(grid.cell_of({1.09, 0.02})), CellState::kUnknown);
  EXPECT_EQ(grid.state(grid.cell_of({0.5, 0.07})), CellState::kUnknown);
}

TEST(OccupancyGrid, AMissNeverErasesAHitOfTheSameScan) {
  // The second beam passes through the cell that the first one ended in.
  LaserScan scan = one_beam(0.0, 1.02F);
  scan.angle_increment = 1e-6;
  scan.ranges = {1.02F, 3.0F, 3.0F, 3.0F};
  OccupancyGrid grid;
  insert_level(grid, scan, 0.02, 0.02);
  EXPECT_EQ(grid.state(grid.cell_of({1.04, 0.02})), CellState::kOccupied);

  // And three misses of one scan weigh as one.
  OccupancyGrid once;
  insert_level(once, one_beam(0.0, 3.0F), 0.02, 0.02);
  EXPECT_EQ(grid.probability(grid.cell_of({0.5, 0.02})),
            once.probability(once.cell_of({0.5, 0.02})));
}

TEST(OccupancyGrid, TheOrderOfBeamsDoesNotMatter) {
  const std::vector<Box> room{
      {-4, -3, 4, -2.9}, {-4, 2.9, 4, 3}, {-4, -3, -3.9, 3}, {1, 0, 1.3, 1}};
  const LaserScan forwards = scan_of(room, {0.01, 0.02}, 360);
  LaserScan backwards = forwards;
  std::reverse(backwards.ranges.begin(), backwards.ranges.end());
  backwards.angle_min = forwards.angle_min + 359 * forwards.angle_increment;
  backwards.angle_increment = -forwards.angle_increment;
  OccupancyGrid a, b;
  insert_level(a, forwards, 0.01, 0.02);
  insert_level(b, backwards, 0.01, 0.02);
  ASSERT_EQ(a.evidence().size(), b.evidence().size());
  // Beam angles differ by rounding: a beam through a corner may take either side of it.
  int different = 0;
  for (std::size_t i = 0; i < a.evidence().size(); ++i)
    different += a.evidence()[i] != b.evidence()[i];
  EXPECT_LE(different, 4);
}

TEST(OccupancyGrid, MapsAWorldAsItIs) {
  const std::vector<Box> world{{-4, -3, 4, -2.8}, {-4, 2.8, 4, 3},   {-4, -3, -3.8, 3},
                               {3.8, -3, 4, 3},   {0.5, -1, 1.5, 0}, {-2.5, 0.5, -1.5, 1.5}};
  OccupancyGrid grid;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(-3.5, 3.5), y(-2.5, 2.5);
  std::vector<Eigen::Vector2d> places;
  while (places.size() < 60) {
    const Eigen::Vector2d p(x(random), y(random));
    const bool inside = std::any_of(world.begin(), world.end(), [&](const Box& b) {
      return p.x() > b.x0 && p.x() < b.x1 && p.y() > b.y0 && p.y() < b.y1;
    });
    if (!inside) places.push_back(p);
  }
  for (const auto& p : places) insert_level(grid, scan_of(world, p, 1000), p.x(), p.y());

  int wrong_free = 0, wrong_occupied = 0, free = 0, occupied = 0;
  for (int cy = 0; cy < grid.height(); ++cy) {
    for (int cx = 0; cx < grid.width(); ++cx) {
      const Eigen::Vector2d p = grid.center_of({cx, cy});
      double gap = 1e9;  // to the nearest box, negative inside
      for (const Box& b : world) {
        const double dx = std::max(b.x0 - p.x(), p.x() - b.x1);
        const double dy = std::max(b.y0 - p.y(), p.y() - b.y1);
        gap = std::min(gap, std::max(dx, dy));
      }
      const CellState state = grid.state({cx, cy});
      free += state == CellState::kFree;
      occupied += state == CellState::kOccupied;
      wrong_free += state == CellState::kFree && gap < -0.05;
      wrong_occupied += state == CellState::kOccupied && (gap > 0.05 || gap < -0.05);
    }
  }
  EXPECT_EQ(wrong_free, 0);
  EXPECT_EQ(wrong_occupied, 0);
  EXPECT_GT(free * 0.0025,
            0.97 * (7.6 * 5.6 - 2.0));  // the floor that is not under the boxes [m^2]
  EXPECT_GT(occupied, 0.9 * (2 * 7.6 + 2 * 5.6 + 8.0) / 0.05);
}

TEST(OccupancyGrid, AWorldTurnedByAQuarterGivesTheMapTurnedByAQuarter) {
  const std::vector<Box> world{{1.03, -2.01, 1.53, 0.77}, {-2.21, 1.13, 2.57, 1.31}};
  const std::vector<Box> turned{{-0.77, 1.03, 2.01, 1.53}, {-1.31, -2.21, -1.13, 2.57}};
  OccupancyGrid a, b;
  const Eigen::Vector2d p(0.013, 0.017);
  const LaserScan scan = scan_of(world, p, 720);
  insert_level(a, scan, p.x(), p.y());
  insert_level(b, scan, -p.y(), p.x(), kPi / 2);
  int compared = 0, different = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      const Eigen::Vector2d c = a.center_of({x, y});
      compared += a.state({x, y}) == CellState::kOccupied;
      different += a.probability({x, y}) != b.probability(b.cell_of({-c.y(), c.x()}));
    }
  }
  EXPECT_GT(compared, 50);
  EXPECT_LE(different, 8);  // beams through corners, as above
  // The turned world scanned by a level scanner says the same of its walls.
  OccupancyGrid direct;
  const LaserScan other = scan_of(turned, {-p.y(), p.x()}, 720);
  insert_level(direct, other, -p.y(), p.x());
  EXPECT_EQ(direct.state(direct.cell_of({-0.1, 1.04})), CellState::kOccupied);
  EXPECT_EQ(b.state(b.cell_of({-0.1, 1.04})), CellState::kOccupied);
}

TEST(OccupancyGrid, EvidenceIsClampedSoThatTheMapChangesItsMind) {
  OccupancyGrid grid;
  for (int i = 0; i < 1000; ++i) insert_level(grid, one_beam(0.0, 1.02F), 0.02, 0.02);
  const Cell wall = grid.cell_of({1.04, 0.02}), air = grid.cell_of({0.5, 0.02});
  EXPECT_NEAR(grid.probability(wall), 0.97, 1e-3);
  EXPECT_NEAR(grid.probability(air), 0.05, 1e-3);
  int scans = 0;
  while (grid.state(wall) != CellState::kFree && scans < 100) {
    insert_level(grid, one_beam(0.0, 2.02F), 0.02, 0.02);
    ++scans;
  }
  // (logit 0.97 - logit 0.35) / -logit 0.4
  EXPECT_EQ(scans, static_cast<int>(std::ceil((3.476 + 0.619) / 0.405)));
}

TEST(OccupancyGrid, GrowthKeepsWhatIsKnownWhereItIs) {
  OccupancyGrid grid;
  insert_level(grid, one_beam(0.3, 2.0F), 0.02, 0.02);
  std::vector<std::pair<Eigen::Vector2d, double>> known;
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      if (grid.probability({x, y}) != 0.5)
        known.emplace_back(grid.center_of({x, y}), grid.probability({x, y}));
    }
  }
  ASSERT_GT(known.size(), 30U);
  const int before = grid.width() * grid.height();
  insert_level(grid, one_beam(0.0, 3.0F), -20.0, -30.0);
  insert_level(grid, one_beam(0.0, 3.0F), 25.0, 14.0);
  EXPECT_GT(grid.width() * grid.height(), before);
  for (const auto& [place, probability] : known) {
    EXPECT_EQ(grid.probability(grid.cell_of(place)), probability);
    EXPECT_LT((grid.center_of(grid.cell_of(place)) - place).norm(), 1e-9);
  }
}

TEST(OccupancyGrid, RefusesToOutgrowItsLimitAndStaysAsItWas) {
  OccupancyGrid::Params params;
  params.max_cells = 40'000;
  OccupancyGrid grid(params);
  insert_level(grid, one_beam(0.0, 1.0F), 0.0, 0.0);
  const auto before = grid.evidence();
  const auto refused = grid.insert(one_beam(0.0, 1.0F), {500.0, 0.0, 1.0}, from_yaw(0));
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().reason, testing::HasSubstr("40000"));
  EXPECT_EQ(grid.evidence(), before);
}

TEST(OccupancyGrid, FloorAndCeilingNeverBecomeObstacles) {
  // A vehicle 1 m up, tilted by up to 30 degrees, in an endless hall 2.5 m high without any wall.
  std::mt19937 random(11);
  std::uniform_real_distribution<double> tilt(-0.52, 0.52);
  OccupancyGrid grid;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Quaterniond q = exp_so3({tilt(random), tilt(random), tilt(random)});
    const Eigen::Vector3d p(0.0, 0.0, 1.0);
    LaserScan scan = one_beam(-kPi, 0.0F);
    scan.angle_increment = 2 * kPi / 500;
    scan.ranges.clear();
    for (int k = 0; k < 500; ++k) {
      const double angle = scan.angle_min + k * scan.angle_increment;
      const double rise = (q * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0)).z();
      const double range = rise > 0 ? 1.5 / rise : rise < 0 ? -1.0 / rise : 1e9;
      scan.ranges.push_back(range < scan.range_max ? static_cast<float>(range) : kNoReturn);
    }
    const auto result = grid.insert(scan, p, q);
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(result->returns, 0);
  }
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      ASSERT_NE(grid.state({x, y}), CellState::kOccupied) << x << " " << y;
    }
  }
}

TEST(OccupancyGrid, ABeamClearsOnlyWhatItCrossesInsideTheHeightBand) {
  // Down by 30 degrees from 1 m: leaves the band (0.2 m) after 0.8 / tan(30 deg) = 1.386 m.
  OccupancyGrid grid;
  const Eigen::Quaterniond down = exp_so3({0.0, kPi / 6, 0.0});
  const auto result = grid.insert(one_beam(0.0, 2.0F), {0.02, 0.02, 1.0}, down);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->clearing, 1);
  EXPECT_LT(grid.probability(grid.cell_of({1.38, 0.02})), 0.5);
  EXPECT_EQ(grid.probability(grid.cell_of({1.46, 0.02})), 0.5);

  // A return inside the band is an obstacle at its horizontal distance: 1.2 cos(30 deg) = 1.039 m.
  OccupancyGrid wall;
  ASSERT_TRUE(wall.insert(one_beam(0.0, 1.2F), {0.02, 0.02, 1.0}, down).ok());
  EXPECT_GT(wall.probability(wall.cell_of({0.02 + 1.039, 0.02})), 0.5);

  // On the pad below the band, a level scan says nothing.
  OccupancyGrid pad;
  const auto low = pad.insert(one_beam(0.0, 1.2F), {0.0, 0.0, 0.1}, from_yaw(0));
  ASSERT_TRUE(low.ok());
  EXPECT_EQ(low->ignored, 1);
  EXPECT_TRUE(pad.empty());
}

TEST(OccupancyGrid, PolicyOfBeamsWithoutReturn) {
  const Eigen::Vector2d near_end(11.9, 0.02), middle(5.0, 0.02);
  for (const float nothing : {kNoReturn, 12.0F, 81.9F}) {
    OccupancyGrid grid;
    EXPECT_EQ(insert_level(grid, one_beam(0.0, nothing), 0.02, 0.02).clearing, 1);
    EXPECT_LT(grid.probability(grid.cell_of(near_end)), 0.5) << nothing;
    OccupancyGrid::Params params;
    params.clear_without_return = false;
    OccupancyGrid careful(params);
    EXPECT_EQ(insert_level(careful, one_beam(0.0, nothing), 0.02, 0.02).ignored, 1);
    EXPECT_EQ(careful.probability(careful.cell_of(middle)), 0.5);
  }
  // What cannot be read clears nothing: it may be an obstacle before the lens.
  for (const float unreadable : {kUnreadable, -kNoReturn, 0.0F, 0.05F}) {
    OccupancyGrid grid;
    EXPECT_EQ(insert_level(grid, one_beam(0.0, unreadable), 0.02, 0.02).ignored, 1);
    EXPECT_TRUE(grid.empty());
  }
  // Returns beyond max_range clear up to there.
  OccupancyGrid::Params params;
  params.max_range = 4.0;
  OccupancyGrid cut(params);
  insert_level(cut, one_beam(0.0, 8.0F), 0.02, 0.02);
  EXPECT_LT(cut.probability(cut.cell_of({3.9, 0.02})), 0.5);
  EXPECT_EQ(cut.probability(cut.cell_of({4.2, 0.02})), 0.5);
  EXPECT_EQ(cut.probability(cut.cell_of({8.02, 0.02})), 0.5);
}

TEST(OccupancyGrid, RefusesWhatIsNotFinite) {
  const double nan = std::nan("");
  OccupancyGrid grid;
  const LaserScan good = one_beam(0.0, 1.0F);
  EXPECT_FALSE(grid.insert(good, {nan, 0, 1}, from_yaw(0)).ok());
  EXPECT_FALSE(grid.insert(good, {0, 0, 1}, Eigen::Quaterniond(0, 0, 0, 0)).ok());
  EXPECT_FALSE(grid.insert(good, {0, 0, 1}, Eigen::Quaterniond(nan, 0, 0, 1)).ok());
  EXPECT_FALSE(grid.insert(good, {1e300, 0, 1}, from_yaw(0)).ok());
  for (double LaserScan::*field : {&LaserScan::angle_min, &LaserScan::angle_increment,
                                   &LaserScan::range_min, &LaserScan::range_max}) {
    LaserScan bad = good;
    bad.*field = nan;
    EXPECT_FALSE(grid.insert(bad, {0, 0, 1}, from_yaw(0)).ok());
  }
  EXPECT_TRUE(grid.empty());
  OccupancyGrid::Params params;
  params.resolution = nan;
  OccupancyGrid broken(params);
  EXPECT_FALSE(broken.insert(good, {0, 0, 1}, from_yaw(0)).ok());
  EXPECT_TRUE(OccupancyGrid(params, {0, 0}, 10, 10).empty());
}

TEST(OccupancyGrid, AnyBytesAsAScanGiveAnAnswerAndNoNaN) {
  std::mt19937 random(5);
  const double odd[] = {0.0,   -0.0,   1.0, -1.0,         1e-300,
                        1e300, -1e300, 1e9, std::nan(""), std::numeric_limits<double>::infinity(),
                        0.05,  12.0,   3.0, -3.0};
  const auto pick = [&] { return odd[random() % std::size(odd)]; };
  for (int trial = 0; trial < 20000; ++trial) {
    OccupancyGrid::Params params;
    params.max_cells = 200'000;
    OccupancyGrid grid(params);
    LaserScan scan;
    scan.angle_min = pick();
    scan.angle_increment = pick();
    scan.range_min = pick();
    scan.range_max = pick();
    for (int i = 0; i < 5; ++i) scan.ranges.push_back(static_cast<float>(pick()));
    const auto result = grid.insert(scan, {pick(), pick(), pick()},
                                    Eigen::Quaterniond(pick(), pick(), pick(), pick()));
    if (!result.ok()) {
      EXPECT_FALSE(result.error().reason.empty());
      EXPECT_TRUE(grid.empty());
    } else {
      EXPECT_EQ(result->returns + result->clearing + result->ignored, 5);
    }
  }
}

}  // namespace
}  // namespace swiftlet
