// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The real mapper in lockstep: where the scanner sits is what tf_static says.
#include <gtest/gtest.h>

#include "components/lidar_mapper/grid_message.hpp"
#include "components/static_transforms.hpp"
#include "estimation/geometry/so3.hpp"
#include "tests/components/component_bench.hpp"

namespace swiftlet::test {
namespace {

using namespace std::chrono_literals;

/// A body at (1, 2) that looks east, and a scanner with one beam of 2 m along its x axis.
struct MapperBench : Bench {
  std::vector<nav_msgs::msg::OccupancyGrid>& maps = record(topic::map);

  explicit MapperBench(Time last_scan = Time::max()) : Bench("lidar_mapper", "min_height: 0.0") {
    send_odometry({1.0, 2.0, 1.0});
    const auto scan_at = [](Time now) {
      sensor_msgs::msg::LaserScan scan;
      scan.header(make_header(now, frame::kLaser));
      scan.angle_increment(0.01f);
      scan.range_min(0.1f);
      scan.range_max(10.0f);
      scan.ranges({2.0f});
      return scan;
    };
    every(topic::scan, 100ms, Time{}, scan_at, last_scan);
  }
  void tell(Time time, const StaticTransforms::Pose& mount) {
    const auto publisher =
        std::make_shared<Publisher<tf2_msgs::msg::TFMessage>>(probe.advertise(topic::tf_static));
    at(time, publisher, [mount](Time now) {
      tf2_msgs::msg::TFMessage message;
      message.transforms({to_transform(now, frame::kBody, frame::kLaser, mount)});
      return message;
    });
  }
  /// The centre of the only occupied cell.
  Eigen::Vector2d occupied() const {
    Eigen::Vector2d place(-100.0, -100.0);
    if (maps.empty()) return place;
    const OccupancyGrid grid = from_msg(maps.back(), {});
    int count = 0;
    for (int y = 0; y < grid.height(); ++y) {
      for (int x = 0; x < grid.width(); ++x) {
        if (grid.state({x, y}) != CellState::kOccupied) continue;
        place = grid.center_of({x, y});
        ++count;
      }
    }
    EXPECT_EQ(count, 1);
    return place;
  }
};

TEST(LidarMapper, MapsFromWhereTfStaticPutsTheScanner) {
  MapperBench bench;
  bench.tell(Time(1s), {{0.3, 0.0, 0.1}, from_yaw(M_PI / 2)});  // turned to the left
  bench.run_until(Time(2s));
  EXPECT_LT((bench.occupied() - Eigen::Vector2d(1.3, 4.0)).norm(), 0.05);
}

TEST(LidarMapper, WithoutAPlaceOfTheScannerThereIsNoMap) {
  MapperBench bench;
  bench.run_until(Time(4s));
  EXPECT_TRUE(bench.maps.empty());
}

TEST(LidarMapper, ScansWaitUntilThePlaceIsTold) {
  MapperBench bench(Time(950ms));
  bench.tell(Time(1s), {});
  bench.run_until(Time(2s));
  EXPECT_LT((bench.occupied() - Eigen::Vector2d(3.0, 2.0)).norm(), 0.05);
}

}  // namespace
}  // namespace swiftlet::test
