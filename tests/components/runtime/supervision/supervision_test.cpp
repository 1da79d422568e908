// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Instances of one component in several participants, live.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "all_messages.hpp"
#include "components/runtime/host.hpp"
#include "components/runtime/supervision/node_announcer.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using rosgraph_msgs::msg::Clock;
using swiftlet_msgs::msg::ComponentStatus;
using ::testing::HasSubstr;

constexpr Topic<Clock> kBeat{"beat", qos::state, 5ms};
constexpr Topic<Clock> kFood{"food", qos::sensor, 20ms};

/// Sends its instance's number at 200 Hz; cannot work without food.
struct Heart : Component {
  explicit Heart(const ComponentContext& context) : Component(context) {
    beat_ = advertise(kBeat);
    subscribe(kFood, [](const Clock&) {});
    int number = 0;
    parameters().read("number", number);
    parameters().read("gain", gain_);
    set_changeable_parameters(
        {{"gain"}, {}, nullptr, [this](const Config& changed) { changed.read("gain", gain_); }});
    every(5ms, [this, number](Time) {
      Clock beat;
      beat.clock().sec(number);
      beat_.publish(beat);
    });
  }
  double gain_ = 1.0;
  Publisher<Clock> beat_;
};
const RegisterComponent<Heart> kRegistered{"test_heart", "beats"};

HostOptions on_domain(int standby) {
  HostOptions options;
  options.participant.domain = 79;
  options.participant.name = "heart" + std::to_string(standby);
  options.standby = standby;
  return options;
}

/// One process with a heart.
struct Body {
  Host host;
  Component& heart;
  std::thread thread;

  explicit Body(int standby)
      : host(on_domain(standby)),
        heart(host.add("test_heart",
                       Config::parse("number: " + std::to_string(standby), "test.yaml"))),
        thread([this] { host.run(); }) {}
  ~Body() {
    host.executor().stop(0);
    thread.join();
  }
};

struct Ear : Component {
  using Component::advertise, Component::every, Component::now;
  explicit Ear(const ComponentContext& context) : Component(context) {
    subscribe(kBeat, [this](const Clock& beat) {
      const std::lock_guard<std::mutex> lock(mutex);
      beats.emplace_back(now(), beat.clock().sec());
    });
    subscribe(topic::component_status, [this](const ComponentStatus& status) {
      const std::lock_guard<std::mutex> lock(mutex);
      last_status[status.process()] = status;
    });
    subscribe(topic::parameter_reply, [this](const swiftlet_msgs::msg::ParameterReply& reply) {
      const std::lock_guard<std::mutex> lock(mutex);
      replies.push_back(reply);
    });
    request = advertise(topic::parameter_request);
  }
  template <class Condition>
  bool wait_for(Condition condition) {
    for (int i = 0; i < 1000; ++i) {
      {
        const std::lock_guard<std::mutex> lock(mutex);
        if (condition()) return true;
      }
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }
  bool heard_from(int number) const {
    return std::any_of(beats.begin(), beats.end(),
                       [number](const auto& beat) { return beat.second == number; });
  }

  std::mutex mutex;
  std::vector<std::pair<Time, int>> beats;
  std::map<std::string, ComponentStatus> last_status;
  std::vector<swiftlet_msgs::msg::ParameterReply> replies;
  Publisher<swiftlet_msgs::msg::ParameterRequest> request;
};

struct Observer {
  Host host;
  Ear& ear;
  std::thread thread;
  Observer() : host(on_domain(9)), ear(host.emplace<Ear>("ear")), thread([this] { host.run(); }) {}
  ~Observer() {
    host.executor().stop(0);
    thread.join();
  }
};

TEST(Supervision, TheStandbyGoesOnWhereTheFirstFellSilent) {
  Observer observer;
  Ear& ear = observer.ear;
  Body first(0);
  Body second(1);
  ASSERT_TRUE(
      ear.wait_for([&] { return ear.heard_from(0) && ear.last_status.count("heart1") > 0; }));
  {
    const std::lock_guard<std::mutex> lock(ear.mutex);
    EXPECT_FALSE(ear.heard_from(1)) << "one of them is heard";
    EXPECT_TRUE(ear.last_status["heart0"].active());
    EXPECT_FALSE(ear.last_status["heart1"].active());
  }
  first.heart.halt();
  ASSERT_TRUE(ear.wait_for([&] { return ear.heard_from(1); }));
  const std::lock_guard<std::mutex> lock(ear.mutex);
  const auto takeover = std::find_if(ear.beats.begin(), ear.beats.end(),
                                     [](const auto& beat) { return beat.second == 1; });
  EXPECT_LT(to_seconds(takeover->first - std::prev(takeover)->first), 0.2)
      << "three periods of 20 ms, and what a busy machine adds";
  EXPECT_TRUE(
      std::none_of(takeover, ear.beats.end(), [](const auto& beat) { return beat.second == 0; }));
}

TEST(Supervision, SaysWhatAComponentMisses) {
  Observer observer;
  Ear& ear = observer.ear;
  Body body(0);
  ASSERT_TRUE(ear.wait_for([&] {
    const auto& problems = ear.last_status["heart0"].problems();
    return problems.size() == 1 && problems[0].find("food: nobody writes it") == 0;
  }));
  auto food = ear.advertise(kFood);
  ASSERT_TRUE(ear.wait_for([&] {
    food.publish(Clock());
    return ear.last_status["heart0"].problems().empty();
  }));
}

TEST(Supervision, AnswersForItsParameters) {
  Observer observer;
  Ear& ear = observer.ear;
  Body body(0);
  swiftlet_msgs::msg::ParameterRequest request;
  request.id("a");
  request.component_name("test_heart");
  request.command(swiftlet_msgs::msg::ParameterRequest_Constants::SET);
  request.name("gain");
  request.value("4");
  ASSERT_TRUE(ear.wait_for([&] {
    ear.request.publish(request);
    return !ear.replies.empty();
  }));
  const std::lock_guard<std::mutex> lock(ear.mutex);
  EXPECT_TRUE(ear.replies[0].accepted()) << ear.replies[0].reason();
  EXPECT_EQ(ear.replies[0].process(), "heart0");
  EXPECT_EQ(static_cast<Heart&>(body.heart).gain_, 4.0);
}

TEST(Lockstep, ASupervisedComponentIsActiveFromTheBeginning) {
  struct Counter : Component {
    Counter(const ComponentContext& context, int& count) : Component(context) {
      subscribe(kBeat, [&count](const Clock&) { ++count; });
      call_at(Time(102ms), [this](Time) { stop(0); });
    }
  };
  HostOptions options;
  options.lockstep = true;
  Host host(options);
  host.add("test_heart");
  int count = 0;
  host.emplace<Counter>("counter", count);
  EXPECT_EQ(host.run(), 0);
  EXPECT_EQ(count, 20);
}

TEST(NodeAnnouncer, GroupsTheEndpointsOfThisParticipantByComponent) {
  const std::string own = "01.0f.a2.b3.00.00.00.00.00.00.00.01";
  const auto endpoint = [](const std::string& id, const char* component, bool is_writer) {
    Endpoint end;
    end.id = id;
    end.component = component;
    end.is_writer = is_writer;
    return end;
  };
  const auto info = nodes_of(
      own, "uav1",
      {endpoint(own + "|0.0.1.3", "planner", true), endpoint(own + "|0.0.2.4", "planner", false),
       endpoint(own + "|0.0.3.4", "commander", false),
       endpoint("02" + own.substr(2) + "|0.0.1.3", "sim", true)});
  EXPECT_EQ(info.gid().data()[1], 0x0f);
  EXPECT_EQ(info.gid().data()[14], 0x01);
  EXPECT_EQ(info.gid().data()[15], 0xc1);
  EXPECT_EQ(info.gid().data()[16], 0);
  ASSERT_EQ(info.node_entities_info_seq().size(), 2u);
  const auto& planner = info.node_entities_info_seq()[1];
  EXPECT_EQ(planner.node_namespace(), "/uav1");
  EXPECT_EQ(planner.node_name(), "planner");
  ASSERT_EQ(planner.writer_gid_seq().size(), 1u);
  EXPECT_EQ(planner.writer_gid_seq()[0].data()[15], 3);
  ASSERT_EQ(planner.reader_gid_seq().size(), 1u);
  EXPECT_EQ(planner.reader_gid_seq()[0].data()[14], 2);
}

}  // namespace
}  // namespace swiftlet
