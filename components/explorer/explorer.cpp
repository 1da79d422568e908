// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/exploration/explorer.hpp"

#include <optional>

#include "components/conversions.hpp"
#include "components/lidar_mapper/grid_message.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kTick = 500ms;
constexpr Duration kAlivePeriod = 500ms;  // large maps take their time

namespace status = swiftlet_msgs::msg::Exploration_Constants;

Explorer::Params read_params(const Config& config) {
  Explorer::Params params;
  double radius = 0.25, margin = 0.10;
  config.read("radius", radius, kPositive);
  config.read("margin", margin, kNotNegative);
  params.clearance = radius + margin;
  config.read("range", params.range, kPositive);
  config.read("frontier_extent", params.frontier_extent, kPositive);
  config.read("least_area", params.least_area, kNotNegative);
  config.read("near", params.near, kPositive);
  config.read("patience", params.patience, {1, 1000});
  config.read("rule_of_1997", params.rule_of_1997);
  return params;
}

/// Says where to look next while the commander flies Indoor Exploration.
class ExplorerComponent : public Component {
 public:
  explicit ExplorerComponent(const ComponentContext& context)
      : Component(context), explorer_(read_params(parameters())) {
    set_alive_period(kAlivePeriod);
    exploration_ = advertise(topic::exploration);
    subscribe(topic::odometry, [this](const nav_msgs::msg::Odometry& odometry) {
      position_ = from_msg(odometry).p_WB.head<2>();
    });
    subscribe(topic::map, [this](const nav_msgs::msg::OccupancyGrid& map) {
      if (exploring_) grid_ = from_msg(map, OccupancyGrid::Params());
    });
    subscribe(topic::vehicle_status, [this](const swiftlet_msgs::msg::VehicleStatus& message) {
      const bool explores =
          message.mode() == swiftlet_msgs::msg::VehicleStatus_Constants::INDOOR_EXPLORATION;
      if (explores && !exploring_) begin();
      exploring_ = explores;
    });
    subscribe(
        topic::goal,
        [this](const geometry_msgs::msg::PoseStamped& goal) {
          goal_stamp_ = from_msg(goal.header().stamp());
          goal_ = from_msg(goal.pose().position()).head<2>();
        },
        Need::kOptional);
    subscribe(
        topic::trajectory,
        [this](const swiftlet_msgs::msg::Trajectory& answer) { on_answer(answer); },
        Need::kOptional);
    every(kTick, [this](Time now) {
      if (active() && exploring_) step(now);
    });
  }

 private:
  void begin() {
    explorer_.reset();
    grid_ = OccupancyGrid();
    looked_at_.reset();
  }

  /// A viewpoint to which the planner finds no way is given up.
  void on_answer(const swiftlet_msgs::msg::Trajectory& answer) {
    const bool failed = answer.status() == swiftlet_msgs::msg::Trajectory_Constants::FAILED;
    const bool mine = looked_at_ && from_msg(answer.goal_stamp()) == goal_stamp_ &&
                      (goal_ - *looked_at_).norm() < grid_.resolution();
    if (!failed || !mine || !exploring_) return;
    log()->info("no way to ({:.2f}, {:.2f}): {}; given up", goal_.x(), goal_.y(), answer.reason());
    explorer_.give_up();
    looked_at_.reset();
  }

  void step(Time now) {
    const ExplorationStep step = explorer_.step(grid_, position_);
    swiftlet_msgs::msg::Exploration message;
    message.header(make_header(now, frame::kMap));
    message.frontiers(static_cast<std::uint32_t>(step.frontiers));
    message.reason(step.reason);
    switch (step.kind) {
      case ExplorationStep::Kind::kLook:
        message.status(status::LOOK);
        message.viewpoint(to_point({step.viewpoint.x(), step.viewpoint.y(), 0.0}));
        looked_at_ = step.viewpoint;
        break;
      case ExplorationStep::Kind::kFinished:
        message.status(status::FINISHED);
        break;
      case ExplorationStep::Kind::kStuck:
        message.status(status::STUCK);
        break;
    }
    exploration_.publish(message);
  }

  Explorer explorer_;
  bool exploring_ = false;
  OccupancyGrid grid_;
  Eigen::Vector2d position_ = Eigen::Vector2d::Zero();
  std::optional<Eigen::Vector2d> looked_at_;
  Time goal_stamp_{};
  Eigen::Vector2d goal_ = Eigen::Vector2d::Zero();
  Publisher<swiftlet_msgs::msg::Exploration> exploration_;
};

const RegisterComponent<ExplorerComponent> kRegistered{
    "explorer", "where to look next in a place that is not known yet"};

}  // namespace
}  // namespace swiftlet
