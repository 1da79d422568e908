// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/correlative_matcher.hpp"

#include <gtest/gtest.h>

#include "tests/perception/slam/floor_plan.hpp"

namespace swiftlet::test {
namespace {

using Eigen::Vector2d;

std::vector<Vector2d> positions_at(const Pose2& pose, const ScanPoints& points) {
  std::vector<Vector2d> result;
  for (const SurfacePoint& p : points) result.push_back(pose * p.position);
  return result;
}

std::vector<Vector2d> seen_from(const Pose2& pose, int beams, std::mt19937& random) {
  return positions_at({}, scan_points(office_floor().scan(pose, beams, 2 * M_PI, 0.01, random)));
}

/// Of what can be seen from some places along the corridor.
std::vector<Vector2d> map_of_office(std::mt19937& random) {
  std::vector<Vector2d> map;
  for (const Vector2d& place : {Vector2d(1.5, 1.5), Vector2d(7, 1.5), Vector2d(12, 1.5)}) {
    const Pose2 pose{place, 0.3};
    const auto points = scan_points(office_floor().scan(pose, 720, 2 * M_PI, 0.01, random));
    for (const Vector2d& p : positions_at(pose, points)) map.push_back(p);
  }
  return map;
}

TEST(LikelihoodField, CoarseLevelsAreTheMostOfWhatTheyCover) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Vector2d> points;
  for (int i = 0; i < 40; ++i) points.emplace_back(uniform(random), uniform(random));
  LikelihoodField::Params params;
  params.levels = 5;
  const LikelihoodField field(points, params);
  for (int level = 0; level < field.levels(); ++level) {
    for (int trial = 0; trial < 300; ++trial) {
      const int x = static_cast<int>(random() % 90) - 25, y = static_cast<int>(random() % 90) - 25;
      int most = 0;
      for (int dy = 0; dy < 1 << level; ++dy) {
        for (int dx = 0; dx < 1 << level; ++dx) most = std::max(most, field.at(0, x + dx, y + dy));
      }
      EXPECT_EQ(field.at(level, x, y), most) << level << " at " << x << " " << y;
    }
  }
}

/// All poses of the window, one after the other.
double best_score_by_trying(const LikelihoodField& field, const std::vector<Vector2d>& points,
                            const Pose2& guess, const SearchWindow& window) {
  double reach = 0.0;
  for (const Vector2d& p : points) reach = std::max(reach, p.norm());
  const int turns = static_cast<int>(std::ceil(window.angle * reach / field.resolution()));
  const int cells = static_cast<int>(std::ceil(window.distance / field.resolution()));
  double best = 0.0;
  for (int turn = -turns; turn <= turns; ++turn) {
    const Eigen::Rotation2Dd R(guess.yaw + window.angle * turn / turns);
    for (int dy = -cells; dy <= cells; ++dy) {
      for (int dx = -cells; dx <= cells; ++dx) {
        int sum = 0;
        for (const Vector2d& p : points) {
          const Vector2d cell = (guess.position + R * p - field.origin()) / field.resolution();
          sum += field.at(0, static_cast<int>(std::floor(cell.x())) + dx,
                          static_cast<int>(std::floor(cell.y())) + dy);
        }
        best = std::max(best, sum / (255.0 * static_cast<double>(points.size())));
      }
    }
  }
  return best;
}

TEST(CorrelativeMatcher, FindsTheBestOfAllPosesInTheWindow) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const LikelihoodField field(map_of_office(random), {});
  SearchWindow window;
  window.distance = 0.4;
  window.angle = 0.1;
  window.least_score = 0.0;
  window.distance_penalty = window.angle_penalty = 0.0;
  for (int trial = 0; trial < 12; ++trial) {
    const Pose2 truth{{6.0 + 3.0 * uniform(random), 1.5 + 0.4 * uniform(random)},
                      M_PI * uniform(random)};
    const auto points = seen_from(truth, 60, random);
    Pose2 guess = truth;
    guess.position += 0.5 * Vector2d(uniform(random), uniform(random));
    guess.yaw += 0.12 * uniform(random);
    const auto match = find_best_match(field, points, guess, window);
    ASSERT_TRUE(match);
    EXPECT_NEAR(match->score, best_score_by_trying(field, points, guess, window), 1e-12) << trial;
  }
}

TEST(CorrelativeMatcher, FindsAPoseThatIsMetresAwayAndTurnedAround) {
  std::mt19937 random(4);
  const LikelihoodField field(map_of_office(random), {});
  const Pose2 truth{{8.3, 1.2}, 2.5};
  SearchWindow window;
  window.distance = 6.0;
  window.angle = M_PI;
  const auto match =
      find_best_match(field, seen_from(truth, 120, random), {{5.0, 1.7}, 0.0}, window);
  ASSERT_TRUE(match);
  EXPECT_LT((match->pose.position - truth.position).norm(), 0.10);
  EXPECT_NEAR(wrap_angle(match->pose.yaw - truth.yaw), 0.0, 0.02);
  EXPECT_GT(match->score, 0.7);
}

TEST(CorrelativeMatcher, OfPlacesThatLookTheSameTheNearerIsTaken) {
  std::mt19937 random(5);
  FloorPlan plan;  // pillars, all alike
  for (int i = 0; i < 8; ++i) plan.add_box({2.0 * i, 1.0}, {2.0 * i + 0.5, 1.5});
  std::vector<Vector2d> map;
  for (int i = 0; i < 8; ++i) {
    const Pose2 pose{{2.0 * i, 0.0}, M_PI_2};
    const auto points = scan_points(plan.scan(pose, 200, 1.5, 0.0, random));
    for (const Vector2d& p : positions_at(pose, points)) map.push_back(p);
  }
  const auto points =
      positions_at({}, scan_points(plan.scan({{6.1, 0.0}, M_PI_2}, 120, 1.5, 0.0, random)));
  SearchWindow window;
  window.distance = 5.0;
  window.angle = 0.1;
  const auto match =
      find_best_match(LikelihoodField(map, {}), points, {{5.7, 0.0}, M_PI_2}, window);
  ASSERT_TRUE(match);
  EXPECT_NEAR(match->pose.position.x(), 6.1, 0.1);
}

TEST(CorrelativeMatcher, WhereNothingFitsThereIsNoMatch) {
  std::mt19937 random(6);
  const LikelihoodField field(map_of_office(random), {});
  std::vector<Vector2d> elsewhere;
  for (int i = 0; i < 60; ++i) elsewhere.emplace_back(0.2 * (i % 8) - 0.8, 0.2 * (i / 8.0) - 0.8);
  SearchWindow window;
  window.least_score = 0.5;
  EXPECT_FALSE(find_best_match(field, elsewhere, {{8.0, 1.5}, 0.0}, window));
  EXPECT_FALSE(find_best_match(field, {}, {{8.0, 1.5}, 0.0}, window));
  EXPECT_FALSE(find_best_match(LikelihoodField({}, {}), elsewhere, {}, window));
}

}  // namespace
}  // namespace swiftlet::test
