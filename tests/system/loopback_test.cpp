// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Without --network nothing leaves this machine.
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <set>
#include <sstream>

#include "tests/system/live_vehicle.hpp"

namespace swiftlet::test {
namespace {

namespace fs = std::filesystem;

struct Socket {
  std::string protocol;
  std::uint32_t address = 0;  ///< IPv4, the first number in the highest byte
  std::uint64_t inode = 0;
};

std::uint32_t byte_swapped(std::uint32_t value) {
  return __builtin_bswap32(value);
}

/// Sockets of one process, as /proc shows them.
std::vector<Socket> sockets_of(pid_t process) {
  const fs::path proc = fs::path("/proc") / std::to_string(process);
  std::set<std::uint64_t> own;
  for (const auto& entry : fs::directory_iterator(proc / "fd")) {
    struct stat status {};
    if (stat(entry.path().c_str(), &status) == 0 && S_ISSOCK(status.st_mode)) {
      own.insert(status.st_ino);
    }
  }
  std::vector<Socket> sockets;
  for (const std::string protocol : {"udp", "udp6", "tcp", "tcp6"}) {
    std::ifstream table(proc / "net" / protocol);
    std::string line;
    std::getline(table, line);  // titles
    while (std::getline(table, line)) {
      std::istringstream fields(line);
      std::string slot, local, remote, state, queues, timer, retransmit, user, timeout;
      Socket socket;
      fields >> slot >> local >> remote >> state >> queues >> timer >> retransmit >> user >>
          timeout >> socket.inode;
      if (own.count(socket.inode) == 0) continue;
      socket.protocol = protocol;
      // The kernel prints the address as the machine, little-endian, stores it.
      socket.address =
          byte_swapped(static_cast<std::uint32_t>(std::stoul(local.substr(0, 8), nullptr, 16)));
      sockets.push_back(socket);
    }
  }
  return sockets;
}

/// Interfaces on which somebody in the network of `process` listens to DDS's multicast group.
std::set<std::string> interfaces_joined(pid_t process) {
  const std::string group = "0100FFEF";  // 239.255.0.1
  std::ifstream table(fs::path("/proc") / std::to_string(process) / "net" / "igmp");
  std::set<std::string> interfaces;
  std::string line;
  std::string interface;
  std::getline(table, line);  // titles
  while (std::getline(table, line)) {
    std::istringstream fields(line);
    std::string first;
    fields >> first;
    if (line[0] != '\t' && line[0] != ' ') {
      fields >> interface;
    } else if (first == group) {
      interfaces.insert(interface);
    }
  }
  return interfaces;
}

/// A network of its own, with a loopback and a pair of real interfaces that are up and have
/// addresses, so that what tries to leave the machine can.
class LoopbackOnly : public LiveVehicleTest {
 protected:
  void SetUp() override {
    if (geteuid() != 0) GTEST_SKIP() << "making a network needs root";
    holder_.emplace(start_command({"unshare", "--net", "sh", "-c",
                                   "echo 1 > /proc/sys/net/ipv6/conf/all/disable_ipv6;"
                                   "ip link set lo up && ip link add near type veth peer name far "
                                   "&& ip addr add 192.0.2.1/24 dev near "
                                   "&& ip link set near up && ip link set far up "
                                   "&& ip route add default via 192.0.2.2 "
                                   "&& echo ready && exec sleep 1000"}));
    const bool settled = becomes_true(Seconds(5.0), [this] {
      return !holder_->running() || holder_->out().find("ready") != std::string::npos;
    });
    if (!settled || !holder_->running()) {
      GTEST_SKIP() << "no network can be made here: " << holder_->err();
    }
  }

  /// `swiftlet <arguments>` in that network.
  Process start_inside(const Arguments& arguments) {
    Arguments command{"nsenter", "--target", std::to_string(holder_->id()), "--net",
                      SWIFTLET_PROGRAM};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return start_command(command);
  }

  std::string sent_packets(const std::string& interface) {
    Process reader = start_command({"nsenter", "--target", std::to_string(holder_->id()), "--net",
                                    "ip", "-json", "-stats", "link", "show", interface});
    const auto finished = reader.wait(kExitLimit);
    if (!finished || finished->exit_code != 0) return "unknown";
    return nlohmann::json::parse(finished->out)[0]["stats64"]["tx"]["packets"].dump();
  }

  bool answers(const Arguments& gcs) {
    Process client = start_inside(gcs);
    const auto finished = client.wait(kExitLimit);
    return finished && finished->exit_code == 0;
  }

  std::optional<Process> holder_;
};

TEST_F(LoopbackOnly, AVehicleInAClosedNetworkWorksAndSendsNothingOut) {
  ASSERT_EQ(sent_packets("near"), "0");
  std::vector<Process> hosts;
  hosts.push_back(start_inside({"run", "sim", "--scenario", hop()}));
  hosts.push_back(start_inside({"run", "estimator", "flight_controller"}));
  hosts.push_back(start_inside({"run", "commander"}));
  ASSERT_TRUE(becomes_true(Seconds(30.0), [&] {
    return answers({"gcs", "arm"});
  })) << hosts[2].err();

  for (const Process& host : hosts) {
    const auto sockets = sockets_of(host.id());
    EXPECT_GE(sockets.size(), 3U);
    for (const Socket& socket : sockets) {
      const bool is_loopback = socket.address >> 24 == 127;
      const bool is_multicast = socket.address >> 28 == 0xE;  // joined where igmp says
      EXPECT_EQ(socket.protocol, "udp");
      EXPECT_TRUE(is_loopback || is_multicast) << std::hex << socket.address;
    }
  }
  EXPECT_EQ(interfaces_joined(hosts[0].id()), std::set<std::string>{"lo"});
  EXPECT_EQ(sent_packets("near"), "0");
  for (Process& host : hosts) expect_end(host, SIGTERM, 0);
  EXPECT_EQ(sent_packets("near"), "0");
}

TEST_F(LoopbackOnly, WithAnInterfaceNamedItIsUsed) {
  Process host = start_inside({"run", "commander", "--network", "192.0.2.1"});
  EXPECT_TRUE(becomes_true(kStartLimit, [&] { return sent_packets("near") != "0"; })) << host.err();
  EXPECT_THAT(interfaces_joined(host.id()), testing::Contains("near"));
  expect_end(host, SIGTERM, 0);
}

}  // namespace
}  // namespace swiftlet::test
