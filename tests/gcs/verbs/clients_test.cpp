// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "components/conversions.hpp"
#include "components/runtime/host.hpp"
#include "components/static_transforms.hpp"
#include "gcs/verbs/battery_view.hpp"
#include "gcs/verbs/cloud_client.hpp"
#include "gcs/verbs/first_message.hpp"
#include "gcs/verbs/log_client.hpp"
#include "gcs/verbs/map_client.hpp"
#include "gcs/verbs/outlook_client.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
namespace mode = swiftlet_msgs::msg::VehicleStatus_Constants;

/// A vehicle that says what a test wants.
struct Puppet : Component {
  Puppet(const ComponentContext& context, const std::function<void(Puppet&)>& begin)
      : Component(context) {
    begin(*this);
  }
  using Component::advertise;
  using Component::call_at;
  using Component::every;
  using Component::now;

  /// Says `make(now)` every `period`, from `from` on.
  template <class T, class Make>
  void say(const Topic<T>& topic, Duration period, Make make, Time from = Time{}) {
    every(period, [writer = advertise(topic), make, from](Time now) mutable {
      if (now >= from) writer.publish(make(now));
    });
  }
};

HostOptions lockstep() {
  HostOptions options;
  options.participant.name = "lockstep";
  options.lockstep = true;
  options.start = Time(1000s);
  return options;
}
const Time kBegin(1000s);

/// A puppet and a client, until the client ends the run.
template <class Client>
struct Trial {
  Host host{lockstep()};
  Client* client = nullptr;
  int exit_code = -1;
  Duration took{};

  template <class... Args>
  explicit Trial(const std::function<void(Puppet&)>& begin, Args&&... args) {
    host.emplace<Puppet>("puppet", begin);
    client = &host.emplace<Client>("gcs", std::forward<Args>(args)...);
    exit_code = host.run();
    took = host.executor().now() - kBegin;
  }
};

void nobody(Puppet&) {}

swiftlet_msgs::msg::VehicleStatus status(std::uint8_t in, const std::string& reason = "") {
  swiftlet_msgs::msg::VehicleStatus status;
  status.mode(in);
  status.armed(in != mode::GROUNDED);
  status.reason(reason);
  return status;
}

nav_msgs::msg::Odometry odometry(Time time, const Eigen::Vector3d& position, double yaw = 0.0) {
  RigidBodyState state;
  state.p_WB = position;
  state.q_WB = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
  return to_odometry(time, state);
}

TEST(FirstMessage, IsTheFirstOneOrNoneInTime) {
  using Client = FirstMessage<swiftlet_msgs::msg::VehicleStatus>;
  const Trial<Client> heard(
      [](Puppet& self) {
        self.say(topic::vehicle_status, 100ms, [](Time) { return status(mode::HOVER, "so"); });
      },
      topic::vehicle_status, 2s);
  EXPECT_EQ(heard.exit_code, 0);
  ASSERT_TRUE(heard.client->message());
  EXPECT_EQ(heard.client->message()->reason(), "so");
  EXPECT_LE(heard.took, 200ms);
  const Trial<Client> none(nobody, topic::vehicle_status, 2s);
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_FALSE(none.client->message());
  EXPECT_GE(none.took, 2s);
}

sensor_msgs::msg::BatteryState battery(double current, double charge) {
  sensor_msgs::msg::BatteryState battery;
  battery.percentage(0.75F);
  battery.voltage(15.0F);
  battery.current(static_cast<float>(-current));
  battery.charge(static_cast<float>(charge));
  return battery;
}

TEST(BatteryClient, EndsAsSoonAsTheTimeLeftIsKnown) {
  const Trial<BatteryClient> run(
      [](Puppet& self) {
        self.say(topic::battery, 500ms, [](Time) { return battery(12.0, 2.0); });
      },
      Duration(10s));
  EXPECT_EQ(run.exit_code, 0);
  ASSERT_TRUE(run.client->view());
  EXPECT_NEAR(run.client->view()->seconds_left.value_or(0.0), 600.0, 1.0);
  EXPECT_LT(run.took, 1s);
}

TEST(BatteryClient, WaitsForWhatIsNotKnownAndSaysWhatItHas) {
  const double none = std::nan("");
  const Trial<BatteryClient> run(
      [none](Puppet& self) {
        self.say(topic::battery, 500ms, [none](Time) { return battery(none, none); });
      },
      Duration(3s));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_GE(run.took, 3s);
  ASSERT_TRUE(run.client->view());
  EXPECT_FALSE(run.client->view()->seconds_left);
  EXPECT_EQ(run.client->view()->report.percentage, 0.75);
  EXPECT_EQ(Trial<BatteryClient>(nobody, Duration(3s)).exit_code, 1);
}

nav_msgs::msg::OccupancyGrid small_map() {
  nav_msgs::msg::OccupancyGrid map;
  map.info().width(4);
  map.info().height(3);
  map.info().resolution(0.5F);
  map.info().origin(to_pose({-1.0, 2.0, 0.0}, Eigen::Quaterniond::Identity()));
  map.data().assign(12, 0);
  map.data()[0] = 100;
  return map;
}

TEST(MapClient, TakesAMapThatWasSaidOnceBeforeItCame) {
  const Trial<MapClient> run(
      [](Puppet& self) {
        auto writer =
            std::make_shared<Publisher<nav_msgs::msg::OccupancyGrid>>(self.advertise(topic::map));
        self.call_at(kBegin, [writer](Time) { writer->publish(small_map()); });
      },
      Duration(5s), false);
  EXPECT_EQ(run.exit_code, 0);
  ASSERT_TRUE(run.client->map());
  EXPECT_EQ(run.client->map()->data()[0], 100);
  EXPECT_LT(run.took, 500ms);
  const Trial<MapClient> none(nobody, Duration(5s), false);
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_GE(none.took, 5s);
}

/// All that an OutlookClient waits for, but for the map.
void say_outlook(Puppet& self) {
  self.say(topic::vehicle_status, 100ms, [](Time) { return status(mode::GROUNDED); });
  self.say(topic::odometry, 10ms, [](Time now) { return odometry(now, {3.0, 4.0, 0.1}); });
  self.say(topic::battery, 1s, [](Time) { return battery(10.0, 2.0); });
  self.say(topic::vehicle_limits, 1s, [](Time) {
    swiftlet_msgs::msg::FlightLimits limits;
    limits.fence_radius(20.0);
    limits.gps_speed(2.5);
    return limits;
  });
}

TEST(OutlookClient, EndsWhenAllIsKnown) {
  const Trial<OutlookClient> run(
      [](Puppet& self) {
        say_outlook(self);
        self.say(topic::map, 200ms, [](Time) { return small_map(); });
      },
      10s, false);
  EXPECT_LT(run.took, OutlookClient::kMoment);
  ASSERT_TRUE(run.client->circumstances());
  const screen::Circumstances& seen = *run.client->circumstances();
  EXPECT_TRUE(seen.check.on_ground);
  EXPECT_EQ(seen.check.takeoff.x(), 3.0);
  EXPECT_EQ(seen.check.fence.radius, 20.0);
  EXPECT_EQ(seen.check.flown_speed, 2.5);
  EXPECT_NEAR(seen.check.charge, 0.75, 1e-6);
  EXPECT_THAT(seen.unknown, ElementsAre(HasSubstr("commander.endurance is not set"), "obstacles"))
      << "half a metre a cell is coarse";
}

TEST(OutlookClient, DoesNotWaitLongForAMapAlone) {
  const Trial<OutlookClient> run(say_outlook, 10s, false);
  EXPECT_LT(run.took, OutlookClient::kMoment);
  EXPECT_THAT(run.client->circumstances()->unknown, testing::Contains("obstacles"));
}

TEST(OutlookClient, WaitsAMomentForWhereTheMapIsOnEarth) {
  const Trial<OutlookClient> run(say_outlook, 10s, true);
  EXPECT_GE(run.took, OutlookClient::kMoment);
  EXPECT_LT(run.took, OutlookClient::kMoment + 200ms);
  EXPECT_THAT(run.client->circumstances()->unknown, testing::Contains("where the map is on Earth"));
}

TEST(OutlookClient, NamesAllWhereNobodySpeaks) {
  const Trial<OutlookClient> run(nobody, 5s, false);
  EXPECT_GE(run.took, 5s);
  EXPECT_THAT(run.client->circumstances()->unknown,
              ElementsAre("where it takes off", "its speeds", "the fence", "the battery's reach",
                          "obstacles"));
}

TEST(MapClient, WaitsForTheVehicleForAMomentOnly) {
  const auto only_map = [](Puppet& self) {
    self.say(topic::map, 200ms, [](Time) { return small_map(); });
  };
  const Trial<MapClient> alone(only_map, Duration(5s), true);
  EXPECT_EQ(alone.exit_code, 0);
  EXPECT_GE(alone.took, MapClient::kSceneWait);
  EXPECT_LT(alone.took, MapClient::kSceneWait + 500ms);
  const auto vehicle = [&only_map](Puppet& self, std::uint8_t in) {
    only_map(self);
    self.say(topic::odometry, 10ms, [](Time now) { return odometry(now, {1.0, 2.5, 1.0}); });
    self.say(topic::vehicle_status, 100ms, [in](Time) { return status(in); });
  };
  const Trial<MapClient> hovers([&](Puppet& self) { vehicle(self, mode::HOVER); }, Duration(5s),
                                true);
  EXPECT_LT(hovers.took, 500ms) << "there is nothing more to come";
  EXPECT_EQ(hovers.client->model().pose()->p_WB.y(), 2.5);
  const Trial<MapClient> flies(
      [&](Puppet& self) {
        vehicle(self, mode::INDOOR_NAVIGATION);
        self.say(
            topic::path, 100ms,
            [](Time) {
              nav_msgs::msg::Path path;
              path.poses().resize(2);
              return path;
            },
            kBegin + 700ms);
      },
      Duration(5s), true);
  EXPECT_GE(flies.took, 700ms) << "its path is waited for";
  EXPECT_LT(flies.took, MapClient::kSceneWait + 300ms);
  EXPECT_EQ(flies.client->model().path()->size(), 2u);
}

/// A vehicle that flies east at 1 m/s along a wall, which its scanner sees to its left.
void scan_along_a_wall(Puppet& self) {
  auto mounts =
      std::make_shared<Publisher<tf2_msgs::msg::TFMessage>>(self.advertise(topic::tf_static));
  self.call_at(kBegin, [mounts](Time now) {
    tf2_msgs::msg::TFMessage message;
    message.transforms().push_back(
        to_transform(now, "base_link", "laser", {{0.0, 0.0, 0.1}, Eigen::Quaterniond::Identity()}));
    mounts->publish(message);
  });
  self.say(topic::odometry, 10ms, [](Time now) {
    return odometry(now, {to_seconds(now - kBegin), 0.0, 1.0});
  });
  self.say(topic::scan, 100ms, [](Time now) {
    sensor_msgs::msg::LaserScan scan;
    scan.header(make_header(now, "laser"));
    scan.angle_min(static_cast<float>(M_PI / 2));
    scan.angle_increment(0.01F);
    scan.range_min(0.1F);
    scan.range_max(10.0F);
    scan.ranges({3.0F});
    return scan;
  });
}

TEST(CloudClient, GathersAWallWhileItFliesAlong) {
  CloudParams params;
  params.length = 4s;
  params.voxel = 0.02;
  Terminal terminal;
  const Trial<CloudClient> run(scan_along_a_wall, params, terminal);
  EXPECT_EQ(run.exit_code, 0);
  ASSERT_TRUE(run.client->done());
  const auto points = run.client->collector().cloud().points();
  EXPECT_NEAR(static_cast<double>(points.size()), 40.0, 3.0);
  double least = 1e9, most = -1e9;
  for (const Eigen::Vector3d& point : points) {
    EXPECT_NEAR(point.y(), 3.0, 1e-3);
    EXPECT_NEAR(point.z(), 1.1, 1e-3);
    least = std::min(least, point.x());
    most = std::max(most, point.x());
  }
  EXPECT_NEAR(most - least, 4.0, 0.3);
  EXPECT_NEAR(to_seconds(run.took), 4.0, 0.7);
}

TEST(CloudClient, SaysWhyThereIsNone) {
  CloudParams params;
  params.patience = 3s;
  Terminal terminal;
  const Trial<CloudClient> none(nobody, params, terminal);
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_FALSE(none.client->done());
  EXPECT_THAT(none.client->problem(), HasSubstr("no scan is heard in domain 0 for 3 s"));
  const Trial<CloudClient> lost(
      [](Puppet& self) {
        self.say(topic::scan, 100ms, [](Time now) {
          sensor_msgs::msg::LaserScan scan;
          scan.header(make_header(now, "laser"));
          return scan;
        });
      },
      params, terminal);
  EXPECT_EQ(lost.exit_code, 1);
  EXPECT_THAT(lost.client->problem(),
              AllOf(HasSubstr("none could be placed"), HasSubstr("no odometry is heard")));
  params.topic = "depth/points";
  const Trial<CloudClient> other(nobody, params, terminal);
  EXPECT_THAT(other.client->problem(), HasSubstr("swiftlet topic info depth/points"));
}

TEST(CloudClient, TakesACloudOfAnotherTopic) {
  CloudParams params;
  params.topic = "depth/points";
  params.length = 1s;
  Terminal terminal;
  const Trial<CloudClient> run(
      [](Puppet& self) {
        self.say(Topic<sensor_msgs::msg::PointCloud2>{"depth/points", qos::map}, 200ms, [](Time) {
          sensor_msgs::msg::PointCloud2 cloud;
          cloud.header().frame_id("map");
          cloud.width(1);
          cloud.height(1);
          cloud.point_step(12);
          cloud.row_step(12);
          cloud.data().assign(12, 0);
          for (const char* name : {"x", "y", "z"}) {
            sensor_msgs::msg::PointField field;
            field.name(name);
            field.offset(static_cast<std::uint32_t>(4 * cloud.fields().size()));
            field.datatype(sensor_msgs::msg::PointField_Constants::FLOAT32);
            cloud.fields().push_back(field);
          }
          return cloud;
        });
      },
      params, terminal);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.client->collector().cloud().size(), 1u);
}

std::vector<std::string> logged(const std::function<void(Puppet&)>& begin, Duration length,
                                int* exit_code = nullptr) {
  std::vector<std::string> texts;
  const Trial<LogClient> run(begin, std::optional<Duration>(length),
                             [&texts](const screen::Event& event) { texts.push_back(event.text); });
  if (exit_code != nullptr) *exit_code = run.exit_code;
  return texts;
}

TEST(LogClient, TellsOfModesOnceWithTheirReasons) {
  int exit_code = -1;
  const auto texts = logged(
      [](Puppet& self) {
        self.say(topic::vehicle_status, 100ms, [](Time now) {
          return now < kBegin + 2s ? status(mode::HOVER) : status(mode::LAND, "battery low");
        });
      },
      4s, &exit_code);
  EXPECT_EQ(exit_code, 0);
  EXPECT_THAT(texts, ElementsAre("vehicle heard: Hover", "Hover → Land: battery low"));
}

TEST(LogClient, TellsOfCommandsWhoeverGivesThemAndWhyTheyAreRefused) {
  const auto texts = logged(
      [](Puppet& self) {
        self.say(topic::vehicle_status, 100ms, [](Time) { return status(mode::GROUNDED); });
        self.say(
            topic::mode_ack, 200ms,
            [](Time) {
              swiftlet_msgs::msg::CommandAck ack;
              ack.id("a");
              ack.reason("not armed");
              ack.name("takeoff");
              ack.station("tablet");
              return ack;
            },
            kBegin + 1s);
      },
      3s);
  EXPECT_THAT(texts, ElementsAre("vehicle heard: Grounded", "takeoff refused: not armed (tablet)"));
}

TEST(LogClient, TellsOfComponentsAndMissions) {
  const auto texts = logged(
      [](Puppet& self) {
        self.say(topic::vehicle_status, 100ms, [](Time) { return status(mode::GROUNDED); });
        self.say(topic::component_status, 100ms, [](Time now) {
          swiftlet_msgs::msg::ComponentStatus component;
          component.component_name("planner");
          component.active(true);
          if (now > kBegin + 1s) component.problems({"map: nobody writes it"});
          return component;
        });
        self.say(topic::mission_state, 500ms, [](Time now) {
          swiftlet_msgs::msg::MissionState mission;
          if (now < kBegin + 2s) return mission;
          mission.state(1);
          mission.id("m");
          mission.count(7);
          return mission;
        });
      },
      4s);
  EXPECT_THAT(texts, ElementsAre("vehicle heard: Grounded", "planner: map: nobody writes it",
                                 "mission of 7 items uploaded"));
}

TEST(LogClient, WithoutAVehicleItHasFailed) {
  int exit_code = -1;
  EXPECT_THAT(logged(nobody, 2s, &exit_code), IsEmpty());
  EXPECT_EQ(exit_code, 1);
}

TEST(LogLine, IsOneObjectWhateverAReasonHolds) {
  const screen::Event event{Time(1500ms), screen::Severity::kCaution, "bad \xff\n\"bytes\"", 3};
  const std::string line = json_line_of(event);
  EXPECT_THAT(line, testing::Not(HasSubstr("\n")));
  const auto json = nlohmann::json::parse(line);
  EXPECT_EQ(json["time"], 1.5);
  EXPECT_EQ(json["severity"], "caution");
  EXPECT_EQ(json["times"], 3);
  EXPECT_THAT(json["text"].get<std::string>(), HasSubstr("\n\"bytes\""));
  EXPECT_THAT(line_of(event), HasSubstr("bad \xff\n\"bytes\" ×3"));
}

}  // namespace
}  // namespace swiftlet
