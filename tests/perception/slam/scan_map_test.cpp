// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/slam/scan_map.hpp"

#include <gtest/gtest.h>

#include "tests/perception/slam/floor_plan.hpp"

namespace swiftlet::test {
namespace {

class ScanMapTest : public testing::Test {
 protected:
  ScanMapTest() {
    params_.min_height = 0.0;
    std::mt19937 random(1);
    for (int i = 0; i < 8; ++i) {
      poses_.push_back({{1.5 + 0.7 * i, 1.4}, 0.1 * i});
      auto scan = std::make_shared<LevelledScan>();
      scan->scan = office_floor().scan(poses_.back(), 360, 2 * M_PI, 0.01, random);
      scan->motion.height = 1.0;
      scans_.push_back(std::move(scan));
    }
  }
  /// Drawn at once.
  std::vector<std::int16_t> expected() const {
    ScanMap map(params_);
    map.update(scans_, poses_);
    return map.grid().evidence();
  }
  OccupancyGrid::Params params_;
  std::vector<LevelledScanPtr> scans_;
  std::vector<Pose2> poses_;
};

TEST_F(ScanMapTest, GrowingPieceByPieceGivesTheSameMap) {
  ScanMap map(params_);
  for (std::size_t count = 1; count <= scans_.size(); ++count) {
    map.update({scans_.begin(), scans_.begin() + static_cast<std::ptrdiff_t>(count)},
               {poses_.begin(), poses_.begin() + static_cast<std::ptrdiff_t>(count)});
  }
  EXPECT_EQ(map.grid().evidence(), expected());
  EXPECT_EQ(map.redrawn(), 0);
  EXPECT_EQ(map.grid().state(map.grid().cell_of({3.0, 1.0})), CellState::kFree);
  EXPECT_EQ(map.grid().state(map.grid().cell_of({4.02, 0.3})), CellState::kOccupied);
}

TEST_F(ScanMapTest, WhatHasMovedIsDrawnAnew) {
  ScanMap map(params_);
  std::vector<Pose2> wrong = poses_;
  for (std::size_t i = 4; i < wrong.size(); ++i) wrong[i].position.y() += 0.4;
  map.update(scans_, wrong);
  EXPECT_NE(map.grid().evidence(), expected());
  map.update(scans_, poses_);
  EXPECT_EQ(map.redrawn(), 1);
  EXPECT_EQ(map.grid().evidence(), expected());
}

TEST_F(ScanMapTest, AMillimetreIsNoReasonToDrawAnew) {
  ScanMap map(params_);
  map.update(scans_, poses_);
  for (Pose2& pose : poses_) pose.position.x() += 0.001;
  map.update(scans_, poses_);
  EXPECT_EQ(map.redrawn(), 0);
}

TEST_F(ScanMapTest, AScanThatCannotBeReadIsCounted) {
  auto broken = std::make_shared<LevelledScan>();
  broken->scan.ranges = {1.0f};
  scans_[2] = broken;  // its ranges cannot be
  ScanMap map(params_);
  map.update(scans_, poses_);
  EXPECT_EQ(map.refused(), 1);
  EXPECT_FALSE(map.grid().empty());
}

}  // namespace
}  // namespace swiftlet::test
