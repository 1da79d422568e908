// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// rtps_peer DOMAIN answer|ask
//
// Two processes that talk in all the ways that the runtime knows: small and large samples, reliable
// and not, kept for those who come later and not. "answer" is the one that the test sends bytes to;
// "ask" says how many answers it got.
#include <cstdio>
#include <string>

#include "components/runtime/host.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Topic<nav_msgs::msg::Odometry> question{"question", qos::state};
constexpr Topic<swiftlet_msgs::msg::CommandAck> answer{"answer", qos::state};
constexpr Topic<sensor_msgs::msg::LaserScan> glance{"glance", qos::sensor};
constexpr Topic<nav_msgs::msg::OccupancyGrid> picture{"picture", qos::map};
constexpr Topic<sensor_msgs::msg::Image> film{"film", qos::bulk};
constexpr std::size_t kLarge = 150'000;  // above what one datagram takes

struct Answerer : Component {
  explicit Answerer(const ComponentContext& context) : Component(context) {
    answer_ = advertise_always<swiftlet_msgs::msg::CommandAck>(answer.name, answer.qos);
    picture_ = advertise(picture);
    subscribe(question, [this](const nav_msgs::msg::Odometry& asked) {
      swiftlet_msgs::msg::CommandAck reply;
      reply.id(asked.child_frame_id());
      answer_.publish(reply);
    });
    subscribe(glance, [](const sensor_msgs::msg::LaserScan&) {});
    subscribe(film, [](const sensor_msgs::msg::Image&) {});
    subscribe(picture, [](const nav_msgs::msg::OccupancyGrid&) {});
    call_at(now() + 100ms, [this](Time) { picture_.publish(large_grid()); });
  }

  static nav_msgs::msg::OccupancyGrid large_grid() {
    nav_msgs::msg::OccupancyGrid grid;
    grid.data().assign(kLarge, 7);
    return grid;
  }

  Publisher<swiftlet_msgs::msg::CommandAck> answer_;
  Publisher<nav_msgs::msg::OccupancyGrid> picture_;
};

struct Asker : Component {
  explicit Asker(const ComponentContext& context) : Component(context) {
    question_ = advertise(question);
    glance_ = advertise(glance);
    picture_ = advertise(picture);
    film_ = advertise(film);
    subscribe(answer, [this](const swiftlet_msgs::msg::CommandAck& reply) {
      // An answer to somebody else would be no proof.
      if (reply.id() == this->context().instance) std::printf("answer %d\n", ++answers_);
      std::fflush(stdout);
    });
    subscribe(picture, [](const nav_msgs::msg::OccupancyGrid&) {});
    every(20ms, [this](Time) { ask(); });
    every(300ms, [this](Time) { show(); });
  }

  void ask() {
    nav_msgs::msg::Odometry odometry;
    odometry.child_frame_id(context().instance);
    question_.publish(odometry);
    sensor_msgs::msg::LaserScan scan;
    scan.ranges().assign(100, 1.0f);
    glance_.publish(scan);
  }

  void show() {
    picture_.publish(Answerer::large_grid());
    sensor_msgs::msg::Image image;
    image.data().assign(kLarge, 9);
    film_.publish(image);
  }

  int answers_ = 0;
  Publisher<nav_msgs::msg::Odometry> question_;
  Publisher<sensor_msgs::msg::LaserScan> glance_;
  Publisher<nav_msgs::msg::OccupancyGrid> picture_;
  Publisher<sensor_msgs::msg::Image> film_;
};

int run(int argc, char** argv) {
  if (argc != 3) return 2;
  HostOptions options;
  options.participant.domain = std::stoi(argv[1]);
  options.participant.name = argv[2];
  Host host(options);
  if (std::string(argv[2]) == "answer") {
    host.emplace<Answerer>("answerer");
  } else {
    host.emplace<Asker>("asker");
  }
  return host.run();
}

}  // namespace
}  // namespace swiftlet

int main(int argc, char** argv) {
  return swiftlet::run(argc, argv);
}
