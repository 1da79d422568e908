// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The clients in lockstep with components of the test's own, on real Fast DDS.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "components/introspection/echo.hpp"
#include "components/introspection/parameter_client.hpp"
#include "components/introspection/status_observer.hpp"
#include "components/introspection/topic_meter.hpp"
#include "components/runtime/host.hpp"
#include "components/runtime/stamp.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A component that does what a test wants.
struct Puppet : Component {
  Puppet(const ComponentContext& context, const std::function<void(Puppet&)>& begin)
      : Component(context) {
    begin(*this);
  }
  using Component::advertise;
  using Component::advertise_raw;
  using Component::context;
  using Component::every;
  using Component::parameters;
  using Component::set_changeable_parameters;
  using Component::subscribe;
};

HostOptions lockstep() {
  HostOptions options;
  options.participant.name = "lockstep";
  options.lockstep = true;
  return options;
}

void talk(Puppet& puppet, Duration period) {
  puppet.every(period, [writer = puppet.advertise(topic::imu0)](Time now) mutable {
    sensor_msgs::msg::Imu imu;
    imu.header(make_header(now, "base_link"));
    imu.linear_acceleration().z(9.5);
    writer.publish(imu);
  });
}

/// What a client prints, line by line.
template <class Client, class Params>
std::vector<std::string> output(const Params& params, const std::function<void(Puppet&)>& begin,
                                int* exit_code = nullptr, std::string* problem = nullptr) {
  Host host(lockstep());
  host.emplace<Puppet>("puppet", begin);
  auto& client = host.emplace<Client>("client", params);
  testing::internal::CaptureStdout();
  const int code = host.run();
  std::istringstream lines(testing::internal::GetCapturedStdout());
  if (exit_code != nullptr) *exit_code = code;
  if (problem != nullptr) *problem = client.problem();
  std::vector<std::string> all;
  for (std::string line; std::getline(lines, line);) all.push_back(line);
  return all;
}

TEST(Rate, IsThatOfThePublisher) {
  MeterParams params;
  params.topic = "/imu0";
  params.count = 3;
  params.json = true;
  for (const Duration period : {Duration(1ms), Duration(40ms)}) {
    const auto lines = output<RateMeter>(params, [&](Puppet& puppet) { talk(puppet, period); });
    ASSERT_EQ(lines.size(), 3u);
    for (const std::string& line : lines) {
      const json report = json::parse(line);
      EXPECT_NEAR(report["rate_hz"], 1.0 / to_seconds(period), 1e-6);
      EXPECT_NEAR(report["min_s"], to_seconds(period), 1e-12);
      EXPECT_NEAR(report["std_dev_s"], 0.0, 1e-12);
    }
    EXPECT_GT(json::parse(lines[2])["window"], json::parse(lines[0])["window"]);
  }
}

TEST(Rate, AWindowForgetsWhatIsOld) {
  MeterParams params;
  params.topic = "imu0";
  params.window = 20;
  params.count = 2;
  params.json = true;
  const auto lines = output<RateMeter>(params, [](Puppet& puppet) { talk(puppet, 1ms); });
  EXPECT_EQ(json::parse(lines.back())["window"], 20);
}

TEST(Bandwidth, IsRateTimesSize) {
  MeterParams params;
  params.topic = "imu0";
  params.count = 2;
  params.json = true;
  const auto lines = output<BandwidthMeter>(params, [](Puppet& puppet) { talk(puppet, 10ms); });
  sensor_msgs::msg::Imu imu;
  imu.header().frame_id("base_link");
  const double size = static_cast<double>(to_cdr(imu).size());
  const json report = json::parse(lines.back());
  EXPECT_EQ(report["mean_bytes"], size);
  EXPECT_NEAR(report["bytes_per_s"].get<double>() / (size * 100.0), 1.0, 0.01);
}

TEST(EchoClient, PrintsAsManyMessagesAsWanted) {
  EchoParams params;
  params.topic = "imu0";
  params.field = "linear_acceleration.z";
  params.count = 2;
  EXPECT_THAT(output<Echo>(params, [](Puppet& puppet) { talk(puppet, 1ms); }),
              ElementsAre("9.5", "---", "9.5", "---"));
  params.field = "";
  params.json = true;
  const auto lines = output<Echo>(params, [](Puppet& puppet) { talk(puppet, 1ms); });
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(json::parse(lines[0])["linear_acceleration"]["z"], 9.5);
}

TEST(EchoClient, SaysWhyThereIsNothingToPrint) {
  int code = 0;
  std::string problem;
  const auto fails = [&](const std::string& topic, const std::string& field,
                         const std::function<void(Puppet&)>& begin) {
    EchoParams params;
    params.topic = topic;
    params.field = field;
    EXPECT_THAT(output<Echo>(params, begin, &code, &problem), IsEmpty());
    return problem;
  };
  const auto talker = [](Puppet& puppet) { talk(puppet, 1ms); };
  EXPECT_THAT(fails("imu", "", talker), HasSubstr("did you mean 'imu0'?"));
  EXPECT_EQ(code, 1);
  EXPECT_THAT(fails("imu0", "linear.z", talker), HasSubstr("has no 'linear'"));
  EXPECT_EQ(code, 2);
  EXPECT_THAT(fails("im u", "", talker), HasSubstr("letters, digits"));
  EXPECT_EQ(code, 2);
  EXPECT_THAT(fails("imu0", "", [](Puppet&) {}), HasSubstr("nothing is seen in domain 0"));
  EXPECT_THAT(fails("imu0", "",
                    [](Puppet& puppet) {
                      puppet.subscribe(topic::imu0, [](const sensor_msgs::msg::Imu&) {});
                    }),
              HasSubstr("nobody writes 'imu0'; it is read by puppet of process lockstep"));
  std::shared_ptr<Writer> odd;
  EXPECT_THAT(fails("odd", "",
                    [&](Puppet& puppet) {
                      odd = puppet.advertise_raw("rt/odd", "vendor_msgs::msg::dds_::Odd_",
                                                 qos::state);
                    }),
              AllOf(HasSubstr("vendor_msgs/msg/Odd"), HasSubstr("--idl")));
}

TEST(EchoClient, ReadsTypesFromTheUsersIdl) {
  const auto library = TypeLibrary::parse(
      {{"odd.idl", "module vendor_msgs { module msg { struct Odd { octet a; long b; }; }; };"}});
  ASSERT_TRUE(library.ok());
  EchoParams params;
  params.topic = "odd";
  params.count = 1;
  params.json = true;
  params.types = &*library;
  const auto lines = output<Echo>(params, [](Puppet& puppet) {
    auto writer = puppet.advertise_raw("rt/odd", "vendor_msgs::msg::dds_::Odd_", qos::state);
    puppet.every(10ms, [writer](Time) { writer->write(Cdr{0, 1, 0, 0, 7, 0, 0, 0, 5, 1, 0, 0}); });
  });
  EXPECT_THAT(lines, ElementsAre(R"({"a":7,"b":261})"));
}

TEST(StatusClient, HearsWhatComponentsSayOfThemselves) {
  Host host(lockstep());
  auto& puppet = host.emplace<Puppet>("puppet", [](Puppet& self) {
    self.subscribe(Topic<sensor_msgs::msg::Imu>{"imu0", qos::sensor, 10ms},
                   [](const sensor_msgs::msg::Imu&) {});
  });
  puppet.supervise(0, Duration(0));
  auto& observer = host.emplace<StatusObserver>("client", kListen);
  EXPECT_EQ(host.run(), 0);
  ASSERT_EQ(observer.instances().size(), 1u);
  const Instance& instance = observer.instances()[0];
  EXPECT_EQ(instance.component, "puppet");
  EXPECT_EQ(instance.state(observer.end()), "active");
  EXPECT_THAT(instance.problems, ElementsAre("imu0: nobody writes it"));
}

struct Asked {
  int exit_code = 0;
  std::string problem;
  std::vector<ParameterClient::Reply> replies;
  std::vector<std::string> silent;
};

Asked ask(const ParameterQuery& query, const std::function<void(Puppet&)>& begin,
          bool supervised = true) {
  Host host(lockstep());
  auto& puppet = host.emplace<Puppet>("puppet", begin);
  if (supervised) puppet.supervise(0, Duration(0));
  auto& client = host.emplace<ParameterClient>("client", query);
  Asked asked;
  asked.exit_code = host.run();
  asked.problem = client.problem();
  asked.replies = client.replies();
  asked.silent = client.silent();
  return asked;
}

namespace request = swiftlet_msgs::msg::ParameterRequest_Constants;

struct Parameters {
  double speed = 1.5;
  double mass = 0.9;
};

std::function<void(Puppet&)> with(Parameters& parameters) {
  return [&parameters](Puppet& puppet) {
    const auto read = [&parameters](const Config& config) {
      config.read("speed", parameters.speed, {0.1, 3.0});
      config.child("model").read("mass", parameters.mass, kPositive);
    };
    read(puppet.parameters());
    puppet.set_changeable_parameters({{"speed"}, {}, nullptr, read});
  };
}

TEST(ParameterQueries, ListGetAndSet) {
  Parameters parameters;
  Asked asked = ask({"puppet", request::LIST, "", ""}, with(parameters));
  ASSERT_EQ(asked.replies.size(), 1u) << asked.problem;
  ASSERT_EQ(asked.replies[0].parameters().size(), 2u);
  EXPECT_EQ(asked.replies[0].parameters()[1].name(), "model.mass");
  asked = ask({"", request::LIST, "", ""}, with(parameters));
  EXPECT_EQ(asked.replies.size(), 1u) << "without a component: all";
  asked = ask({"puppet", request::GET, "model.mass", ""}, with(parameters));
  EXPECT_EQ(asked.replies.at(0).parameters().at(0).value(), "0.9");
  asked = ask({"puppet", request::SET, "speed", "2.5"}, with(parameters));
  EXPECT_TRUE(asked.replies.at(0).accepted()) << asked.replies[0].reason();
  EXPECT_EQ(parameters.speed, 2.5);
}

TEST(ParameterQueries, ARefusalHasItsReason) {
  Parameters parameters;
  const auto reason = [&](const std::string& name, const std::string& value) {
    const Asked asked = ask({"puppet", request::SET, name, value}, with(parameters));
    EXPECT_FALSE(asked.replies.at(0).accepted());
    return asked.replies[0].reason();
  };
  EXPECT_THAT(reason("speed", "9"), HasSubstr("from 0.1 to 3"));
  EXPECT_THAT(reason("model.mass", "1"), HasSubstr("cannot change while it runs"));
  EXPECT_THAT(reason("sped", "1"), HasSubstr("did you mean 'speed'?"));
  EXPECT_EQ(parameters.speed, 1.5);
}

TEST(ParameterQueries, NobodyRunsThatComponent) {
  Parameters parameters;
  const Asked asked = ask({"pupet", request::LIST, "", ""}, with(parameters));
  EXPECT_EQ(asked.exit_code, 1);
  EXPECT_EQ(asked.problem, "nobody runs 'pupet'; did you mean 'puppet'?");
  EXPECT_THAT(ask({"planner", request::LIST, "", ""}, with(parameters)).problem,
              HasSubstr("running are puppet"));
  EXPECT_THAT(ask(
                  {"", request::LIST, "", ""}, [](Puppet&) {}, false)
                  .problem,
              HasSubstr("nothing is seen in domain"));
}

TEST(ParameterQueries, OneThatHearsAndDoesNotAnswerIsNamedWithinTwoSeconds) {
  int heard = 0;
  std::string id;
  Time first{};
  Time last{};
  const Asked asked = ask(
      {"puppet", request::LIST, "", ""},
      [&](Puppet& puppet) {
        puppet.subscribe(topic::parameter_request,
                         [&](const swiftlet_msgs::msg::ParameterRequest& message) {
                           const Time now = from_msg(message.header().stamp());
                           if (heard++ == 0) first = now;
                           last = now;
                           EXPECT_TRUE(id.empty() || id == message.id()) << "one identity";
                           id = message.id();
                         });
      },
      false);
  EXPECT_THAT(asked.silent, ElementsAre("puppet of process lockstep"));
  EXPECT_THAT(asked.replies, IsEmpty());
  EXPECT_GE(heard, 5) << "it is asked again";
  EXPECT_LT(last, Time(2s));
  EXPECT_GT(first, Time(0s));
}

}  // namespace
}  // namespace swiftlet
