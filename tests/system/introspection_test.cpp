// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// topic, component, param and doctor as a user runs them, on processes that run.
#include <atomic>
#include <csignal>
#include <fstream>
#include <thread>

#include "components/topics.hpp"
#include "tests/system/system_test.hpp"

namespace swiftlet::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

/// Every verb is to answer within a second; twice that is left to a busy machine.
constexpr Seconds kAnswer{2.0};

/// Ends of topics in the process of the test.
class Ends {
 public:
  Ends(int domain, const std::string& process) : participant_(options(domain, process)) {}

  std::unique_ptr<Writer> write(const std::string& wire, const std::string& type,
                                const QosProfile& qos, const std::string& component = "talker") {
    return participant_.make_writer({wire, type, qos, component, nullptr});
  }
  std::unique_ptr<Reader> read(const std::string& wire, const std::string& type,
                               const QosProfile& qos, const std::string& component = "listener") {
    return participant_.make_reader({wire, type, qos, component, nullptr}, [] {});
  }

 private:
  static ParticipantOptions options(int domain, const std::string& process) {
    ParticipantOptions options;
    options.domain = domain;
    options.name = process;
    return options;
  }
  Participant participant_;
};

const std::string kImuType = message_type<sensor_msgs::msg::Imu>().dds_name();
const std::string kMapType = message_type<nav_msgs::msg::OccupancyGrid>().dds_name();

/// Writes at an exact rate: a sample that was late does not delay those after it.
class Metronome {
 public:
  Metronome(Writer& writer, Cdr sample, std::chrono::nanoseconds period)
      : thread_([this, &writer, sample = std::move(sample), period] {
          const auto begin = std::chrono::steady_clock::now();
          for (int i = 0; running_; ++i) {
            std::this_thread::sleep_until(begin + i * period);
            writer.write(sample);
          }
        }) {}
  ~Metronome() {
    running_ = false;
    thread_.join();
  }

 private:
  std::atomic<bool> running_{true};
  std::thread thread_;
};

class Introspection : public SystemTest {
 protected:
  /// Runs a verb that must answer in time.
  Finished answer(const Arguments& arguments) {
    Finished finished = run(arguments, kStartLimit);
    EXPECT_LT(finished.duration, kAnswer * kSlowdown) << testing::PrintToString(arguments);
    return finished;
  }
  json answer_json(Arguments arguments) {
    arguments.push_back("--json");
    const Finished finished = answer(arguments);
    json parsed = json::parse(finished.out, nullptr, false);
    EXPECT_FALSE(parsed.is_discarded()) << finished.out << finished.err;
    return parsed;
  }
};

TEST_F(Introspection, ASystemThatIsReadyIsHealthyAndShowsWhatItDoes) {
  Process process = start({"run", "sim", "estimator", "flight_controller", "lidar_mapper",
                           "planner", "commander", "--scenario", hop()});
  ASSERT_TRUE(becomes_true(kStartLimit, [&] { return run({"doctor"}).exit_code == 0; }))
      << run({"doctor"}).out << process.err();
  EXPECT_EQ(answer_json({"doctor"})["healthy"], true);

  std::vector<std::string> names;
  for (const json& topic : answer_json({"topic", "list"})) names.push_back(topic["name"]);
  EXPECT_THAT(names, testing::IsSupersetOf({"imu0", "odometry", "scan", "vehicle/status"}));
  const json info = answer_json({"topic", "info", "/odometry"});
  EXPECT_EQ(info["types"], json({"nav_msgs/msg/Odometry"}));
  EXPECT_EQ(info["writers"][0]["component"], "estimator");
  const Finished pose =
      answer({"topic", "echo", "odometry", "--once", "--field", "pose.pose.orientation.w"});
  EXPECT_EQ(pose.exit_code, 0) << pose.err;
  EXPECT_NEAR(std::abs(std::stod(pose.out)), 1.0, 0.05) << "it stands on the ground";
  const json scan = answer_json({"topic", "echo", "scan", "--once"});
  EXPECT_EQ(scan["header"]["frame_id"], "laser");
  EXPECT_GT(scan["ranges"].size(), 100u);

  const json components = answer_json({"component", "list"});
  ASSERT_EQ(components.size(), 6u);
  for (const json& component : components) EXPECT_EQ(component["state"], "active") << component;
  EXPECT_THAT(answer({"component", "info", "planner"}).out, HasSubstr("reads  map"));

  EXPECT_EQ(answer({"param", "get", "flight_controller", "max_tilt"}).exit_code, 0);
  const Finished refused = answer({"param", "set", "sim", "seed", "7"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("seed"));
  // What is dumped is what the components start with.
  const std::string file = write("dump.yaml", answer({"param", "dump"}).out);
  expect_end(process, SIGINT, 0);
  process = start({"run", "estimator", "flight_controller", "planner", "--params", file});
  ASSERT_TRUE(becomes_true(kStartLimit, [&] {
    return run({"param", "dump", "planner"}).exit_code == 0 || !process.running();
  }));
  EXPECT_TRUE(process.running()) << process.err();
}

TEST_F(Introspection, TheRateOfATopicIsRightWithinOnePercentAt1kHz) {
  Ends ends(domain(), "talkers");
  const QosProfile qos{"test", true, false, 2000, false};  // a reader that is held up loses nothing
  const auto writer = ends.write("rt/imu0", kImuType, qos);
  const Metronome metronome(*writer, to_cdr(sensor_msgs::msg::Imu()), std::chrono::milliseconds(1));
  // Of some seconds, so that a few milliseconds of delay at their ends do not count.
  const Finished hz = run({"topic", "hz", "imu0", "--json", "--count", "5"}, kExitLimit * 3);
  ASSERT_EQ(hz.exit_code, 0) << hz.err;
  const std::string last = hz.out.substr(hz.out.rfind('{'));
  const json report = json::parse(last);
  EXPECT_NEAR(report["rate_hz"].get<double>(), 1000.0, 10.0) << hz.out;
  EXPECT_GT(report["window"], 3000);
}

TEST_F(Introspection, TopicsOfOthersAreReadWhateverTheyOffer) {
  Ends foreign(domain(), "rviz2");
  const auto strong = foreign.write("rt/imu0", kImuType, qos::state, "");
  const auto weak = foreign.write("rt/imu0", kImuType, qos::sensor, "");
  const auto odd = foreign.write("rt/odd", "vendor_msgs::msg::dds_::Odd_", qos::state, "");
  const auto map = foreign.write("rt/map", kMapType, qos::map, "");
  nav_msgs::msg::OccupancyGrid grid;
  grid.data({1, -1, 100});
  map->write(to_cdr(grid));  // long before anybody reads it

  const json late = answer_json({"topic", "echo", "map", "--once"});
  EXPECT_EQ(late["data"], json({1, -1, 100}));
  {
    const Metronome metronome(*weak, to_cdr(sensor_msgs::msg::Imu()), std::chrono::milliseconds(5));
    const Finished heard = answer({"topic", "echo", "imu0", "--once", "--no-arr"});
    EXPECT_EQ(heard.exit_code, 0) << heard.err;
    EXPECT_THAT(heard.out, HasSubstr("linear_acceleration_covariance: '<double[9]>'"));
  }
  const Finished unknown = answer({"topic", "echo", "odd", "--once"});
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.err, AllOf(HasSubstr("vendor_msgs/msg/Odd"), HasSubstr("--idl")));
  const std::string idl =
      write("odd.idl", "module vendor_msgs { module msg { struct Odd { long b; }; }; };");
  const Metronome metronome(*odd, Cdr{0, 1, 0, 0, 42, 0, 0, 0}, std::chrono::milliseconds(5));
  EXPECT_EQ(answer({"topic", "echo", "odd", "--once", "--idl", idl}).out, "b: 42\n---\n");
  const Finished missing = answer({"topic", "echo", "odd", "--once", "--idl", path("no.idl")});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, HasSubstr("no.idl"));

  const json sick = answer_json({"doctor"});
  EXPECT_EQ(sick["healthy"], true) << "strangers are no illness: " << sick;
  EXPECT_EQ(sick["findings"][0]["kind"], "unknown participant");
  EXPECT_THAT(sick["findings"][0]["text"].get<std::string>(),
              AllOf(HasSubstr("'rviz2'"), HasSubstr("imu0, map, odd")));
}

TEST_F(Introspection, TheDoctorNamesBothEndsOfWhatDoesNotFit) {
  Ends a(domain(), "process_a");
  Ends b(domain(), "process_b");
  const auto writer = a.write("rt/imu0", kImuType, qos::sensor);
  const auto reader = b.read("rt/imu0", kImuType, qos::state);
  const auto waiting = b.read("rt/map", kMapType, qos::map);
  const Finished finished = answer({"doctor"});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_THAT(finished.out,
              HasSubstr("nothing flows on 'imu0' from talker of process process_a to listener of "
                        "process process_b: reliability: offered best effort, requested reliable"));
  EXPECT_THAT(finished.out, HasSubstr("'map' [nav_msgs/msg/OccupancyGrid] is read by listener of "
                                      "process process_b, and nobody writes it"));
  EXPECT_THAT(finished.out, HasSubstr("2 problems"));
  EXPECT_EQ(answer_json({"topic", "info", "imu0"})["conflicts"].size(), 1u);
}

TEST_F(Introspection, WhereNothingRunsThatIsSaidAtOnce) {
  for (const Arguments& arguments :
       {Arguments{"topic", "info", "odometry"}, Arguments{"topic", "echo", "odometry"},
        Arguments{"topic", "hz", "odometry"}, Arguments{"topic", "bw", "odometry"},
        Arguments{"component", "info", "planner"}, Arguments{"param", "list"},
        Arguments{"param", "get", "planner", "max_speed"}}) {
    const Finished finished = answer(arguments);
    EXPECT_EQ(finished.exit_code, 1) << testing::PrintToString(arguments);
    EXPECT_FALSE(finished.err.empty());
    EXPECT_EQ(finished.out, "");
  }
  EXPECT_EQ(answer({"topic", "list"}).exit_code, 0);
  EXPECT_EQ(answer({"component", "list"}).exit_code, 0);
  const Finished doctor = answer({"doctor"});
  EXPECT_EQ(doctor.exit_code, 1);
  EXPECT_THAT(doctor.out, AllOf(HasSubstr("nothing is seen in domain " + std::to_string(domain())),
                                HasSubstr("--network")));
  EXPECT_THAT(answer({"component", "list", "--available"}).out, HasSubstr("flight_controller"));
}

TEST_F(Introspection, AProcessThatDiesWhileTheDoctorListensIsMissed) {
  Process process = start({"run", "planner"});
  ASSERT_TRUE(becomes_true(kStartLimit, [&] {
    return run({"component", "list"}).out.find("active") != std::string::npos;
  })) << process.err();
  Process doctor = start({"doctor", "--wait", "3", "--json"});
  // It is seen to listen: the planner's status has a reader.
  ASSERT_TRUE(becomes_true(kStartLimit, [&] {
    const json info =
        json::parse(run({"topic", "info", "component/status", "--json"}).out, nullptr, false);
    return info.is_object() && !info["readers"].empty();
  }));
  process.send(SIGKILL);
  const auto finished = doctor.wait(kExitLimit);
  ASSERT_TRUE(finished);
  EXPECT_EQ(finished->exit_code, 1);
  EXPECT_THAT(finished->out, AllOf(HasSubstr("\"silent\""), HasSubstr("planner")));
}

TEST_F(Introspection, WrongUsageIsExitCode2) {
  for (const Arguments& arguments :
       {Arguments{"topic"}, Arguments{"topic", "echo"},
        Arguments{"topic", "hz", "x", "--window", "1"},
        Arguments{"topic", "echo", "x", "--count", "0"}, Arguments{"param", "set", "planner"},
        Arguments{"doctor", "--wait", "-1"}, Arguments{"component", "lits"},
        Arguments{"topic", "echo", "x", "--once", "--count", "2"}}) {
    EXPECT_EQ(run(arguments).exit_code, 2) << testing::PrintToString(arguments);
  }
}

}  // namespace
}  // namespace swiftlet::test
