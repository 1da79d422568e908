// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// swiftlet launch: what it starts, what it starts again, and how it ends.
#include <fmt/format.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "components/topics.hpp"
#include "tests/system/bad_input.hpp"

namespace swiftlet::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

class Launch : public SystemTest {
 protected:
  static std::string source(const std::string& name) {
    return std::string(SWIFTLET_SOURCE_DIR) + "/components/launch/" + name;
  }

  /// The process that the launch started last under that name; 0 before there is one.
  static pid_t id_of(const Process& launch, const std::string& name) {
    const std::string words = "[launch] [info] " + name + ": started, process ";
    const std::string log = launch.err();
    const std::size_t at = log.rfind(words);
    return at == std::string::npos ? 0 : std::stoi(log.substr(at + words.size()));
  }

  static bool says(const Process& launch, const std::string& words) {
    return launch.err().find(words) != std::string::npos;
  }

  /// Neither running nor a zombie that somebody has still to wait for.
  static bool alive(pid_t process) {
    std::ifstream status(fmt::format("/proc/{}/stat", process));
    std::string line;
    std::getline(status, line);
    return !line.empty() && line.find(") Z") == std::string::npos;
  }

  /// The launch of a file, once all of `names` host their components.
  Process launched(const std::string& content, const std::vector<std::string>& names) {
    Process process = start({"launch", write("system.yaml", content), "--host", "here"});
    EXPECT_TRUE(becomes_true(kStartLimit, [&] {
      return std::all_of(names.begin(), names.end(), [&](const std::string& name) {
        return says(process, "[" + name + "] [") && says(process, "hosting " + name);
      });
    })) << process.err();
    return process;
  }
};

TEST_F(Launch, PrintsTheCommandLinesThatItWouldRun) {
  const std::string file = write("system.yaml", R"(domain: 12
vehicle: uav1
scenario: hop.yaml
network: {interfaces: [eth0], wait: 5}
parameters: {planner: {max_speed: 1.0}}
hosts:
  a:
    discovery_server: {address: 10.0.0.1}
    processes:
      - {components: [estimator, flight_controller], name: control, arguments: [--rt, "50"]}
      - {components: [flight_controller], standby: 1}
    components: [sim]
  b:
    domain: 13
    network: {interfaces: [wlan0], peers: ["10.0.0.1:7410"], multicast: true}
    processes:
      - {verb: [bag, record, -o, "a b.mcap"]}
)");
  write("hop.yaml", "");
  const Finished a = run({"launch", file, "--host", "a", "--dry-run", "--json"});
  ASSERT_EQ(a.exit_code, 0) << a.err;
  const json lines = json::parse(a.out);
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0]["name"], "discovery_server");
  EXPECT_THAT(lines[0]["command"],
              ElementsAre("fast-discovery-server", "-i", "0", "-l", "10.0.0.1", "-p", "11811"));
  EXPECT_EQ(lines[1]["name"], "control");
  EXPECT_THAT(lines[1]["command"],
              ElementsAre(SWIFTLET_PROGRAM, "run", "estimator", "flight_controller", "--params",
                          file, "--domain", "12", "--vehicle", "uav1", "--network", "eth0",
                          "--network-wait", "5", "--rt", "50"));
  EXPECT_EQ(lines[2]["name"], "flight_controller@1");
  EXPECT_THAT(lines[2]["command"], testing::IsSupersetOf({"--standby", "1"}));
  EXPECT_THAT(lines[3]["command"],
              testing::IsSupersetOf(std::vector<std::string>{"--scenario", path("hop.yaml")}));

  const Finished b = run({"launch", file, "--host", "b", "--dry-run"});
  ASSERT_EQ(b.exit_code, 0) << b.err;
  EXPECT_EQ(b.out, fmt::format("bag_record_-o_a b.mcap: {} bag record -o 'a b.mcap' --domain 13 "
                               "--vehicle uav1 --network wlan0 --peer 10.0.0.1:7410 --multicast "
                               "true --network-wait 5\n",
                               SWIFTLET_PROGRAM));
}

TEST_F(Launch, TheExamplesCanBeUsed) {
  EXPECT_EQ(run({"launch", source("office.yaml"), "--dry-run"}).exit_code, 0);
  for (const char* host : {"vehicle", "companion", "ground"}) {
    const Finished finished =
        run({"launch", source("office-three-hosts.yaml"), "--host", host, "--dry-run"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
  }
}

TEST_F(Launch, ACrashedComponentServesAgainWithinTwoSecondsAndTheOthersGoOn) {
  Process launch = launched(fmt::format("scenario: {}\n"
                                        "hosts: {{here: {{components: [sim, estimator]}}}}\n",
                                        std::filesystem::relative(hop(), folder()).string()),
                            {"sim", "estimator"});
  ParticipantOptions options;
  options.domain = domain();
  Participant participant(options);
  const MessageType& type = message_type<nav_msgs::msg::Odometry>();
  const auto reader = participant.make_reader(
      {"rt/odometry", type.dds_name(), topic::odometry.qos, "test", &type}, [] {});
  nav_msgs::msg::Odometry odometry;
  SampleOrigin origin;
  ASSERT_TRUE(becomes_true(kStartLimit, [&] { return reader->take(&odometry, &origin); }))
      << launch.err();
  const pid_t sim = id_of(launch, "sim");
  const pid_t killed = id_of(launch, "estimator");
  const auto first = origin.writer;

  kill(killed, SIGKILL);
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(becomes_true(kStartLimit, [&] {
    while (reader->take(&odometry, &origin)) {
      if (origin.writer != first) return true;
    }
    return false;
  })) << launch.err();
  const Seconds gap = std::chrono::steady_clock::now() - begin;
  std::printf("estimator: serves again %.2f s after SIGKILL\n", gap.count());
  EXPECT_LT(gap.count(), 2.0 * kSlowdown);
  EXPECT_NE(id_of(launch, "estimator"), killed);
  EXPECT_EQ(id_of(launch, "sim"), sim) << "must not have been started again";
  EXPECT_TRUE(alive(sim));
  EXPECT_TRUE(says(launch,
                   "estimator: was ended by signal 9 (Killed); starting it again in 0.1 s "
                   "(1 of 5 in 60 s)"))
      << launch.err();
  expect_end(launch, SIGINT, 0);
  EXPECT_FALSE(alive(sim));
}

TEST_F(Launch, ADiscoveryServerIsStartedAgainOnlyAfterItsClientsMissIt) {
  Process launch =
      start({"launch", write("system.yaml",
                             fmt::format("hosts:\n  here:\n    components: [commander]\n"
                                         "    discovery_server: {{address: 127.0.0.1, port: {}}}\n",
                                         11811 + domain()))});
  ASSERT_TRUE(becomes_true(kStartLimit, [&] { return id_of(launch, "discovery_server") != 0; }))
      << launch.err();
  kill(id_of(launch, "discovery_server"), SIGKILL);
  EXPECT_TRUE(becomes_true(kStartLimit, [&] {
    return says(launch,
                "discovery_server: was ended by signal 9 (Killed); starting it again in 21.0 s");
  })) << launch.err();
  expect_end(launch, SIGINT, 0);
}

// `gcs disarm` fails after a second and a half where there is no vehicle: a crash that comes back.
const char* const kCrashing = R"(restart: {max_restarts: 2, backoff: 0}
hosts:
  here:
    components: [commander]
    processes: [{verb: [gcs, status, --domain, "102"], name: crashing}]
)";

TEST_F(Launch, GivesUpWhatCrashesAgainAndAgainAndEnds) {
  Process launch = start({"launch", write("system.yaml", kCrashing)});
  const auto finished = launch.wait(Seconds(30.0));
  ASSERT_TRUE(finished) << launch.err();
  EXPECT_EQ(finished->exit_code, 1);
  EXPECT_THAT(finished->err, HasSubstr("crashing: ended with exit code 1; it was started again 2 "
                                       "times in 60 s, which is enough"));
  EXPECT_THAT(finished->err, HasSubstr("[crashing] no vehicle answers in domain 102"));
  EXPECT_THAT(finished->err, HasSubstr("commander: ended with exit code 0"));
  EXPECT_FALSE(alive(id_of(launch, "commander")));
}

TEST_F(Launch, GoesOnWithoutItWhereTheFileSaysSo) {
  Process launch =
      start({"launch", write("system.yaml", std::string("on_failure: continue\n") + kCrashing)});
  ASSERT_TRUE(becomes_true(Seconds(30.0), [&] {
    return says(launch, "crashing: given up; the others go on");
  })) << launch.err();
  EXPECT_TRUE(alive(id_of(launch, "commander")));
  expect_end(launch, SIGTERM, 1);  // something was given up
}

TEST_F(Launch, WhatRefusesToStartIsNotStartedAgain) {
  const std::string file = write("system.yaml",
                                 "parameters:\n"
                                 "  commander: {takeoff_sped: 1}\n"
                                 "hosts: {here: {components: [commander]}}\n");
  const Finished finished = run({"launch", file});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_THAT(finished.err, HasSubstr(file + ":2"));
  EXPECT_THAT(finished.err, HasSubstr("did you mean 'takeoff_speed'"));
  EXPECT_THAT(finished.err, HasSubstr("starting it again cannot help"));
  EXPECT_EQ(finished.err.find("commander: started"), finished.err.rfind("commander: started"));
}

TEST_F(Launch, AProgramThatIsNotThereIsSaidToBeSo) {
  environment_["PATH"] = "/nowhere";
  const Finished finished =
      run({"launch", write("system.yaml", "hosts: {here: {discovery_server: {}}}\n")});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_THAT(finished.err, HasSubstr("'fast-discovery-server' cannot be started: No such file"));
}

TEST_F(Launch, KillsWhatDoesNotEndInTime) {
  Process launch =
      launched("stop_timeout: 1\nhosts: {here: {components: [commander]}}\n", {"commander"});
  const pid_t commander = id_of(launch, "commander");
  ASSERT_EQ(kill(commander, SIGSTOP), 0);
  expect_end(launch, SIGTERM, 1);
  EXPECT_TRUE(says(launch, "commander: does not end within 1 s and is killed")) << launch.err();
  EXPECT_FALSE(alive(commander));
}

TEST_F(Launch, ItsProcessesDieWithIt) {
  Process launch =
      launched("hosts: {here: {components: [commander, estimator]}}\n", {"commander", "estimator"});
  const pid_t commander = id_of(launch, "commander");
  const pid_t estimator = id_of(launch, "estimator");
  ASSERT_TRUE(alive(commander) && alive(estimator));
  launch.send(SIGKILL);
  EXPECT_TRUE(becomes_true(kExitLimit, [&] { return !alive(commander) && !alive(estimator); }));
}

TEST_F(Launch, TheSystemdUnitIsValid) {
  std::ifstream unit(std::string(SWIFTLET_BINARY_DIR) + "/components/launch/swiftlet@.service");
  std::stringstream text;
  text << unit.rdbuf();
  std::string content = text.str();
  for (const char* line : {"Type=exec", "Restart=on-failure", "LimitRTPRIO=", "--host %i"}) {
    EXPECT_THAT(content, HasSubstr(line));
  }
  // The program is not installed where the unit will find it.
  const std::size_t begin = content.find("ExecStart=") + 10;
  content.replace(begin, content.find(' ', begin) - begin, SWIFTLET_PROGRAM);
  Process verify =
      start_command({"systemd-analyze", "verify", write("swiftlet@vehicle.service", content)});
  const auto finished = verify.wait(kExitLimit);
  ASSERT_TRUE(finished);
  if (finished->exit_code == 127) GTEST_SKIP() << "systemd-analyze is not installed";
  EXPECT_EQ(finished->exit_code, 0);
  EXPECT_EQ(finished->err, "");
}

class BadSystemFile : public BadInputTest, public testing::WithParamInterface<BadInput> {};

TEST_P(BadSystemFile, IsRefusedWithFileAndLine) {
  expect_refused(GetParam());
}

BadInput system_file(const std::string& name, const std::string& content,
                     const std::vector<std::string>& says,
                     const std::vector<std::string>& more = {}) {
  BadInput input{name, {"launch", "{in}/bad.yaml", "--dry-run"}, says, {{"bad.yaml", content}}};
  input.arguments.insert(input.arguments.end(), more.begin(), more.end());
  return input;
}

INSTANTIATE_TEST_SUITE_P(
    Launch, BadSystemFile,
    testing::Values(
        system_file("NoHosts", "domain: 3\n", {"{in}/bad.yaml:1", "'hosts' is missing"}),
        system_file("NoHost", "hosts: {}\n", {"{in}/bad.yaml:1", "has no host"}),
        system_file("UnknownKey", "domain: 3\nhots:\n  a: {components: [planner]}\n",
                    {"'hosts' is missing"}),
        system_file("UnknownHostKey", "hosts:\n  a:\n    componets: [planner]\n",
                    {"{in}/bad.yaml:3", "did you mean 'components'"}),
        system_file("UnknownComponent", "hosts:\n  a:\n    components: [planer]\n",
                    {"{in}/bad.yaml:3", "did you mean 'planner'"}),
        system_file("UnknownNetworkKey",
                    "hosts:\n  a:\n    network: {interface: [eth0]}\n    components: [planner]\n",
                    {"{in}/bad.yaml:3", "did you mean 'interfaces'"}),
        system_file("ParametersOfNobody",
                    "parameters:\n  plannr: {max_speed: 1}\nhosts: {a: {components: [planner]}}\n",
                    {"{in}/bad.yaml:2", "did you mean 'planner'"}),
        system_file("PeerWithoutSense",
                    "network: {peers: ['10.0.0.1:x']}\nhosts: {a: {components: [planner]}}\n",
                    {"{in}/bad.yaml:1", "'x' is no port"}),
        system_file(
            "ServerWithoutPort",
            "network: {discovery_servers: [10.0.0.1]}\nhosts: {a: {components: [planner]}}\n",
            {"{in}/bad.yaml:1", "needs a port"}),
        system_file("OnFailure", "on_failure: explode\nhosts: {a: {components: [planner]}}\n",
                    {"{in}/bad.yaml:1", "stop or continue"}),
        system_file("SimWithoutScenario", "hosts:\n  a: {components: [sim]}\n",
                    {"{in}/bad.yaml:1", "needs a scenario"}),
        system_file("ScenarioThatIsNotThere",
                    "scenario: nowhere.yaml\nhosts: {a: {components: [sim]}}\n",
                    {"{in}/bad.yaml:1", "there is no file"}),
        system_file("TwiceTheSame", "hosts:\n  a: {components: [planner, planner]}\n",
                    {"{in}/bad.yaml:2", "two processes are called 'planner'"}),
        system_file("TwiceWithoutStandby",
                    "hosts:\n  a:\n    components: [planner]\n"
                    "    processes: [{components: [planner], name: other}]\n",
                    {"'planner' runs twice", "standby"}),
        system_file("NeitherComponentsNorVerb", "hosts:\n  a:\n    processes: [{name: x}]\n",
                    {"{in}/bad.yaml:3", "either 'components' or a 'verb'"}),
        system_file("HostThatIsNotThere", "hosts: {vehicle: {components: [planner]}}\n",
                    {"--host vehicl", "did you mean 'vehicle'"}, {"--host", "vehicl"}),
        system_file("WhichOfThem",
                    "hosts: {some: {components: [planner]}, other: {components: [planner]}}\n",
                    {"say which one it is with --host: other, some"}),
        system_file("NothingToRun", "hosts: {a: {}}\n", {"nothing runs on this host"}),
        BadInput{
            "NoFile", {"launch", "{in}/nowhere.yaml"}, {"{in}/nowhere.yaml", "cannot be read"}}),
    name_of);

}  // namespace
}  // namespace swiftlet::test
