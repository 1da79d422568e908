// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The stack on three hosts: vehicle, companion, ground.
#include <fmt/format.h>

#include <array>
#include <csignal>

#include "diagnostic_msgs.h"
#include "tests/system/virtual_network.hpp"

namespace swiftlet::test {
namespace {

using Places = std::vector<std::array<double, 2>>;

const Places kHop{{2.5, 2.0}};
const Places kOffice{{2.2, 4.4}, {7.6, 5.2}, {9.9, 5.0}, {0.9, 1.05}};

/// A way of discovery: the section `network` of the file, the same for gcs, and what the vehicle
/// runs besides.
struct Discovery {
  std::string name;
  std::string yaml;
  std::vector<std::string> arguments;
  std::string vehicle_runs;
};
std::ostream& operator<<(std::ostream& out, const Discovery& discovery) {
  return out << discovery.name;
}

const Discovery kMulticast{"Multicast", "{interfaces: [eth0]}", {"--network", "eth0"}, ""};
const Discovery kPeers{"UnicastPeers",
                       "{interfaces: [eth0], peers: [10.9.0.1, 10.9.0.2]}",
                       {"--peer", "10.9.0.1", "--peer", "10.9.0.2"},
                       ""};
const Discovery kServer{"DiscoveryServer",
                        "{interfaces: [eth0], discovery_servers: ['10.9.0.1:11811']}",
                        {"--discovery-server", "10.9.0.1:11811"},
                        "discovery_server: {address: 10.9.0.1}"};

class ThreeHosts : public SpreadVehicleTest {
 protected:
  /// Simulator, estimation and control on the vehicle; mapping, planning and command beside it.
  void start(const Discovery& discovery, const std::string& scenario) {
    network_ = discovery.arguments;
    const std::string file =
        write("system.yaml", fmt::format("scenario: {}\n"
                                         "domain: {}\n"
                                         "network: {}\n"
                                         "on_failure: continue\n"
                                         "hosts:\n"
                                         "  vehicle:\n"
                                         "    {}\n"
                                         "    components: [sim, estimator, flight_controller]\n"
                                         "  companion:\n"
                                         "    components: [lidar_mapper, planner, commander]\n",
                                         std::filesystem::relative(scenario, folder()).string(),
                                         domain(), discovery.yaml, discovery.vehicle_runs));
    launch(file, {"vehicle", "companion"});
    record_truth(discovery.arguments);
  }

  void stop() {
    for (auto& [host, process] : launched_) expect_end(process, SIGTERM, 0);
    expect_no_contact();
  }
};

class ThreeHostsFind : public ThreeHosts, public testing::WithParamInterface<Discovery> {};

TEST_P(ThreeHostsFind, EachOtherAndFly) {
  if (IsSkipped()) return;
  const bool full = full_tests();
  start(GetParam(), full ? office() : hop());
  ASSERT_NO_FATAL_FAILURE(fly(full ? kOffice : kHop, full ? 1.25 : 1.0));
  stop();
}

INSTANTIATE_TEST_SUITE_P(By, ThreeHostsFind, testing::Values(kMulticast, kPeers, kServer),
                         [](const auto& test) { return test.param.name; });

class ThreeHostsLose : public ThreeHosts, public testing::WithParamInterface<int> {};

TEST_P(ThreeHostsLose, PacketsAndFlyAllTheSame) {
  if (IsSkipped()) return;
  if (!full_tests()) GTEST_SKIP() << "flies the office for minutes; set SWIFTLET_FULL_TESTS=1";
  for (const char* host : {"vehicle", "companion", "ground"}) lose_on(host, GetParam());
  start(kMulticast, office());
  ASSERT_NO_FATAL_FAILURE(fly(kOffice, 1.25));
  stop();
}

INSTANTIATE_TEST_SUITE_P(Percent, ThreeHostsLose, testing::Values(1, 5),
                         testing::PrintToStringParamName());

TEST_F(ThreeHosts, FlyOnWhileTheDiscoveryServerIsAway) {
  if (IsSkipped()) return;
  // In the full form it stays away for longer than its lease of 20 s; in the short form the lease
  // is short.
  Arguments command{"fast-discovery-server", "-i", "0", "-l", "10.9.0.3", "-p", "11811"};
  if (!full_tests()) {
    command.insert(command.end(),
                   {"-x", SWIFTLET_SOURCE_DIR "/components/launch/discovery-server.xml"});
  }
  Process server = start_command_on("ground", command);
  Discovery discovery = kServer;
  discovery.yaml = "{interfaces: [eth0], discovery_servers: ['10.9.0.3:11811']}";
  discovery.arguments = {"--discovery-server", "10.9.0.3:11811"};
  discovery.vehicle_runs = "";
  start(discovery, hop());
  // One that stays, so that there is somebody who knows them all while the server is away.
  ASSERT_NO_FATAL_FAILURE(take_off(1.0));
  Arguments watch{"gcs", "watch"};
  watch.insert(watch.end(), network_.begin(), network_.end());
  Process watcher = start_on(station_, watch);
  ASSERT_TRUE(becomes_true(Seconds(15.0), [&] {
    return watcher.out().find("Hover") != std::string::npos;
  })) << watcher.out();

  server.send(SIGKILL);
  ASSERT_TRUE(server.wait(kExitLimit));
  EXPECT_TRUE(status().is_null()) << "a new one cannot join without the server";
  const int long_enough = full_tests() ? 25 : 8;
  const auto lines = [&] {
    const std::string out = watcher.out();
    return std::count(out.begin(), out.end(), '\n');
  };
  const auto before = lines();
  ASSERT_TRUE(becomes_true(Seconds(60.0), [&] { return lines() >= before + long_enough; }));
  const std::string seen = watcher.out();
  EXPECT_EQ(seen.find("no vehicle/status", seen.find("Hover")), std::string::npos) << seen;

  server = start_command_on("ground", command);
  status_becomes("seen by a new one", Seconds(10.0), [](const auto&) { return true; });
  ASSERT_NO_FATAL_FAILURE(go_to(2.5, 2.0));
  ASSERT_NO_FATAL_FAILURE(land());
  stop();
}

/// The companion has a radio to the ground besides, and nothing else leads there.
class GroundLinkTest : public SpreadVehicleTest {
 protected:
  static constexpr int kBudget = 12'000;

  void SetUp() override {
    if (kSlowdown > 1) GTEST_SKIP() << "the sanitizers are too slow to fly in real time";
    for (const char* host : {"vehicle", "companion", "ground"}) {
      add_host(host);
      if (IsSkipped()) return;
    }
    connect("vehicle", "eth0", "10.9.0.1/24", "wire");
    connect("companion", "eth0", "10.9.0.2/24", "wire");
    connect("companion", "wlan0", "10.8.0.2/24", "radio");
    connect("ground", "wlan0", "10.8.0.3/24", "radio");
    shell_on("companion", "tc qdisc add dev wlan0 root tbf rate 500kbit burst 8kb latency 300ms");
    network_ = {"--network", "wlan0", "--domain", "7"};
    const std::string file =
        write("system.yaml",
              fmt::format("scenario: {}\n"
                          "domain: {}\n"
                          "network: {{interfaces: [eth0]}}\n"
                          "parameters:\n"
                          "  ground_link:\n"
                          "    domain: 7\n"
                          "    network: {{interfaces: [wlan0]}}\n"
                          "    budget: {}\n"
                          "    outward:\n"
                          "      - {{topic: vehicle/status, rate: 5, essential: true}}\n"
                          "      - {{topic: mode/ack, essential: true}}\n"
                          "      - {{topic: diagnostics, essential: true}}\n"
                          "      - {{topic: battery, rate: 1}}\n"
                          "      - {{topic: odometry, rate: 5}}\n"
                          "      - {{topic: map, rate: 1, resolution: 0.2}}\n"
                          "      - {{topic: scan}}\n"
                          "hosts:\n"
                          "  vehicle:\n"
                          "    components: [sim, estimator, flight_controller]\n"
                          "  companion:\n"
                          "    components: [lidar_mapper, planner, commander, ground_link]\n",
                          std::filesystem::relative(hop(), folder()).string(), domain(), kBudget));
    launch(file, {"vehicle", "companion"});
    record_truth({"--network", "eth0"});
  }

  /// Bytes per second that leave the companion by radio, measured over `window`.
  double outward_rate(Seconds window) {
    const auto begin = std::chrono::steady_clock::now();
    const auto passed = [&] { return Seconds(std::chrono::steady_clock::now() - begin); };
    const std::int64_t before = counter("companion", "wlan0", "tx_bytes");
    becomes_true(window * 2, [&] { return passed() >= window; });
    return static_cast<double>(counter("companion", "wlan0", "tx_bytes") - before) /
           passed().count();
  }
};

TEST_F(GroundLinkTest, CarriesWhatIsListedWithinItsBudgetAndSurvivesACut) {
  if (IsSkipped()) return;
  ASSERT_NO_FATAL_FAILURE(take_off(1.0));

  // What arrives, while scans ask for far more than there is.
  Arguments record{"bag", "record", "-o", path("ground.mcap")};
  record.insert(record.end(), network_.begin(), network_.end());
  Process recorder = start_on("ground", record);
  status_becomes("seen", Seconds(10.0), [](const auto&) { return true; });
  ASSERT_NO_FATAL_FAILURE(go_to(2.5, 2.0));
  const double rate = outward_rate(Seconds(6.0));
  std::printf("ground link: %.0f B/s on the wire with a budget of %d B/s\n", rate, kBudget);
  // Discovery, acknowledgements and heartbeats come on top of what is budgeted.
  EXPECT_LT(rate, 1.5 * kBudget + 4000.0);
  EXPECT_GT(rate, 0.5 * kBudget);
  expect_end(recorder, SIGINT, 0);
  const auto topics = read_topics(path("ground.mcap"));
  for (const char* name : {"vehicle/status", "odometry", "battery", "map", "scan", "diagnostics"}) {
    EXPECT_EQ(topics.count(name), 1U) << name;
  }
  EXPECT_EQ(topics.count("imu0"), 0U) << "was not listed";
  EXPECT_EQ(topics.count("setpoint"), 0U) << "was not listed";
  // Others report on the same topic.
  bool told = false;
  for (const mcap::Bytes& bytes : topics.at("diagnostics")) {
    const auto report = from_cdr<diagnostic_msgs::msg::DiagnosticArray>(bytes);
    ASSERT_TRUE(report.ok()) << report.error().reason;
    for (const auto& status : report->status()) {
      if (status.name() == "ground_link: scan") told = status.level() == 1;
    }
  }
  EXPECT_TRUE(told) << "scans are thinned, and the report does not say so";

  // Cut for ten seconds, longer than the lease: both ends forget each other.
  set_link("ground", "wlan0", false);
  const auto cut = std::chrono::steady_clock::now();
  EXPECT_TRUE(status().is_null());
  ASSERT_TRUE(becomes_true(Seconds(30.0), [&] {
    return std::chrono::steady_clock::now() - cut > std::chrono::seconds(10);
  }));
  set_link("ground", "wlan0", true);
  const auto back = std::chrono::steady_clock::now();
  status_becomes("seen again", Seconds(10.0), [](const auto&) { return true; });
  const Seconds recovery = std::chrono::steady_clock::now() - back;
  std::printf("ground link: seen again %.1f s after a cut of 10 s\n", recovery.count());
  ASSERT_NO_FATAL_FAILURE(land());
  for (auto& [host, process] : launched_) expect_end(process, SIGTERM, 0);
  expect_no_contact();
}

class Interfaces : public NetworkTest {};

TEST_F(Interfaces, OneThatComesUpLaterIsWaitedFor) {
  make_three_hosts();
  if (IsSkipped()) return;
  shell_on("companion", "ip link set eth0 down");
  const Finished refused = run_on("companion", {"gcs", "status", "--network", "eth0"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, testing::HasSubstr("'eth0' is there, but down"));

  Process host =
      start_on("companion", {"run", "commander", "--network", "eth0", "--network-wait", "60"});
  ASSERT_TRUE(becomes_true(kStartLimit, [&] {
    return host.err().find("waiting 60 s") != std::string::npos;
  })) << host.err();
  shell_on("companion", "ip link set eth0 up");
  EXPECT_TRUE(becomes_true(Seconds(20.0), [&] {
    return run_on("ground", {"gcs", "status", "--network", "eth0"}).exit_code == 0;
  })) << host.err();
  expect_end(host, SIGTERM, 0);
}

TEST_F(Interfaces, OneThatVanishesTakesDownNothingOnTheMachine) {
  make_three_hosts();
  if (IsSkipped()) return;
  Process host = start_on("vehicle", {"run", "commander", "--network", "eth0"});
  Process watcher = start_on("vehicle", {"gcs", "watch", "--network", "eth0"});
  const auto seen = [&](const Process& process) {
    const std::string out = process.out();
    std::size_t count = 0;
    for (std::size_t at = 0; (at = out.find("Grounded", at)) != std::string::npos; ++at) ++count;
    return count;
  };
  ASSERT_TRUE(becomes_true(kStartLimit, [&] { return seen(watcher) > 0; })) << watcher.out();
  shell_on("vehicle", "ip addr flush dev eth0 && ip link set eth0 down");
  const std::size_t before = seen(watcher);
  // Longer than the lease of six seconds.
  EXPECT_TRUE(becomes_true(Seconds(25.0), [&] { return seen(watcher) >= before + 9; }))
      << watcher.out();
  EXPECT_EQ(watcher.out().find("no vehicle/status", watcher.out().find("Grounded")),
            std::string::npos)
      << watcher.out();

  // Back with its address, others are found again.
  shell_on("vehicle", "ip link set eth0 up && ip addr add 10.9.0.1/24 dev eth0");
  EXPECT_TRUE(becomes_true(Seconds(20.0), [&] {
    return run_on("ground", {"gcs", "status", "--network", "eth0"}).exit_code == 0;
  })) << host.err();
  expect_end(watcher, SIGTERM, 0);
  expect_end(host, SIGTERM, 0);
}

}  // namespace
}  // namespace swiftlet::test
