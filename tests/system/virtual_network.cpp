// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/system/virtual_network.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <csignal>

#include "swiftlet_msgs.h"

namespace swiftlet::test {
namespace {

constexpr Seconds kShellLimit{10.0};

}  // namespace

Process NetworkTest::make_namespace() {
  Process holder = start_command(
      {"unshare", "--net", "sh", "-c",
       "echo 1 > /proc/sys/net/ipv6/conf/all/disable_ipv6; ip link set lo up && echo ready && exec "
       "sleep 100000"});
  becomes_true(Seconds(5.0), [&] {
    return !holder.running() || holder.out().find("ready") != std::string::npos;
  });
  return holder;
}

void NetworkTest::add_host(const std::string& host) {
  if (geteuid() != 0) GTEST_SKIP() << "making hosts out of network namespaces needs root";
  if (hosts_.empty() && !host.empty()) {
    add_host("");
    if (IsSkipped()) return;
  }
  Process holder = make_namespace();
  if (!holder.running()) {
    GTEST_SKIP() << "no network namespace can be made here: " << holder.err();
  }
  hosts_[host] = holders_.size();
  holders_.push_back(std::move(holder));
}

void NetworkTest::connect(const std::string& host, const std::string& interface,
                          const std::string& address, const std::string& bridge) {
  const int port = static_cast<int>(ports_.size());
  ports_[host + "." + interface] = port;
  shell_on("", fmt::format("ip link show {0} > /dev/null 2>&1 || (ip link add {0} type bridge "
                           "mcast_snooping 0 && ip link set {0} up)",
                           bridge));
  shell_on("", fmt::format("ip link add port{0} type veth peer name {1} netns {2} && "
                           "ip link set port{0} master {3} up",
                           port, interface, id_of(host), bridge));
  shell_on(host, fmt::format("ip addr add {} dev {} && ip link set {} up", address, interface,
                             interface));
}

void NetworkTest::make_three_hosts() {
  int number = 0;
  for (const std::string host : {"vehicle", "companion", "ground"}) {
    add_host(host);
    if (IsSkipped()) return;
    connect(host, "eth0", fmt::format("10.9.0.{}/24", ++number), "wire");
  }
}

pid_t NetworkTest::id_of(const std::string& host) const {
  return holders_.at(hosts_.at(host)).id();
}

Process NetworkTest::start_command_on(const std::string& host, const Arguments& command) {
  Arguments all{"nsenter", "--target", std::to_string(id_of(host)), "--net"};
  all.insert(all.end(), command.begin(), command.end());
  return start_command(all);
}

Process NetworkTest::start_on(const std::string& host, const Arguments& arguments) {
  Arguments command{SWIFTLET_PROGRAM};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return start_command_on(host, command);
}

Finished NetworkTest::run_on(const std::string& host, const Arguments& arguments, Seconds limit) {
  Process process = start_on(host, arguments);
  const auto finished = process.wait(limit);
  if (finished) return *finished;
  ADD_FAILURE() << "did not end: swiftlet " << testing::PrintToString(arguments);
  return {-1, process.out(), process.err(), limit};
}

std::string NetworkTest::shell_on(const std::string& host, const std::string& line) {
  Process process = start_command_on(host, {"sh", "-c", line});
  const auto finished = process.wait(kShellLimit);
  EXPECT_TRUE(finished && finished->exit_code == 0)
      << "on '" << host << "': " << line << ": " << process.err();
  return process.out();
}

void NetworkTest::lose_on(const std::string& host, int percent) {
  shell_on(host, fmt::format("nft add table inet loss && "
                             "nft add chain inet loss input '{{ type filter hook input priority 0; "
                             "}}' && "
                             "nft add rule inet loss input iifname != lo numgen random mod 100 '<' "
                             "{} drop",
                             percent));
}

std::string NetworkTest::port_of(const std::string& host, const std::string& interface) const {
  return fmt::format("port{}", ports_.at(host + "." + interface));
}

void NetworkTest::set_link(const std::string& host, const std::string& interface, bool up) {
  shell_on("", fmt::format("ip link set {} {}", port_of(host, interface), up ? "up" : "down"));
}

std::int64_t NetworkTest::counter(const std::string& host, const std::string& interface,
                                  const std::string& name) {
  // /sys would show the interfaces of the namespace in which it was mounted.
  const std::string line =
      shell_on(host, fmt::format("ip -s -j link show {} | tr -d ' \\n'", interface));
  const auto json = nlohmann::json::parse(line, nullptr, false);
  if (json.is_discarded() || json.empty()) return -1;
  return json[0]["stats64"][name.substr(0, 2)][name.substr(3)].get<std::int64_t>();
}

void SpreadVehicleTest::SetUp() {
  if (kSlowdown > 1) GTEST_SKIP() << "the sanitizers are too slow to fly in real time";
  make_three_hosts();
}

void SpreadVehicleTest::launch(const std::string& file, const std::vector<std::string>& hosts) {
  for (const std::string& host : hosts) {
    launched_.insert_or_assign(host, start_on(host, {"launch", file, "--host", host}));
  }
}

void SpreadVehicleTest::record_truth(const Arguments& network) {
  Arguments arguments{"bag", "record", "-o", path("truth.mcap"), "sim/truth"};
  arguments.insert(arguments.end(), network.begin(), network.end());
  recorder_.emplace(start_on("vehicle", arguments));
}

void SpreadVehicleTest::expect_no_contact() {
  ASSERT_TRUE(recorder_);
  expect_end(*recorder_, SIGINT, 0);
  const auto truth = last_message<swiftlet_msgs::msg::SimTruth>(path("truth.mcap"), "sim/truth");
  EXPECT_EQ(truth.contacts(), 0U) << "touched " << truth.last_contact();
  EXPECT_TRUE(truth.on_ground());
}

void SpreadVehicleTest::command(const Arguments& arguments) {
  Arguments all{"gcs"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  all.insert(all.end(), network_.begin(), network_.end());
  Finished last;
  // A command that was not acknowledged may have been carried out; these can be given again.
  EXPECT_TRUE(becomes_true(Seconds(15.0),
                           [&] {
                             last = run_on(station_, all);
                             return last.exit_code == 0;
                           }))
      << arguments.front() << ": " << last.err << logs();
}

nlohmann::json SpreadVehicleTest::status() {
  Arguments all{"gcs", "status", "--json"};
  all.insert(all.end(), network_.begin(), network_.end());
  const Finished finished = run_on(station_, all);
  if (finished.exit_code != 0) return nullptr;
  const auto json = nlohmann::json::parse(finished.out, nullptr, false);
  return json.is_discarded() || !json.contains("mode") ? nlohmann::json(nullptr) : json;
}

void SpreadVehicleTest::take_off(double altitude) {
  status_becomes("ready", Seconds(30.0), [](const auto& now) { return now["ready"] == true; });
  if (HasFatalFailure()) return;
  command({"arm"});
  command({"takeoff", fmt::format("{}", altitude)});
  status_becomes("hovering", Seconds(20.0), [](const auto& now) { return now["mode"] == "Hover"; });
}

void SpreadVehicleTest::go_to(double x, double y) {
  command({"goto", fmt::format("{}", x), fmt::format("{}", y)});
  status_becomes(fmt::format("at {} {}", x, y), Seconds(60.0), [&](const auto& now) {
    if (!now.contains("position_m") || now["mode"] != "Hover") return false;
    const auto& position = now["position_m"];
    return std::hypot(position[0].template get<double>() - x,
                      position[1].template get<double>() - y) < 0.4;
  });
}

void SpreadVehicleTest::land() {
  command({"land"});
  status_becomes("landed", Seconds(20.0), [](const auto& now) {
    return now["mode"] == "Grounded" && now["armed"] == false;
  });
}

void SpreadVehicleTest::fly(const std::vector<std::array<double, 2>>& places, double altitude) {
  ASSERT_NO_FATAL_FAILURE(take_off(altitude));
  for (const auto& place : places) ASSERT_NO_FATAL_FAILURE(go_to(place[0], place[1]));
  ASSERT_NO_FATAL_FAILURE(land());
}

std::string SpreadVehicleTest::diagnosis() {
  Arguments all{"doctor"};
  all.insert(all.end(), network_.begin(), network_.end());
  return "\n== doctor\n" + run_on(station_, all).out;
}

std::string SpreadVehicleTest::logs() const {
  std::string text;
  for (const auto& [host, process] : launched_) {
    text += fmt::format("\n== {}\n{}", host, process.err());
  }
  return text;
}

}  // namespace swiftlet::test
