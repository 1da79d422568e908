// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Many participants: how soon they know each other, and what it costs on the wire.
#include <fmt/format.h>

#include <csignal>
#include <sstream>

#include "tests/system/virtual_network.hpp"

namespace swiftlet::test {
namespace {

constexpr int kHosts = 3;
constexpr int kOnEach = 10;
constexpr Seconds kSettleLimit{5.0};
/// Thirty processes start on whatever processors there are; what is measured begins afterwards.
constexpr Seconds kAllStarted{60.0};
constexpr Seconds kQuiet{6.0};

struct Way {
  std::string name;
  std::vector<std::string> arguments;
  bool server = false;
  bool only_full = false;
};
std::ostream& operator<<(std::ostream& out, const Way& way) {
  return out << way.name;
}

class ThirtyParticipants : public NetworkTest, public testing::WithParamInterface<Way> {
 protected:
  /// Bytes that all hosts have sent on the wire so far.
  std::int64_t sent() {
    std::int64_t bytes = 0;
    for (const std::string& host : names_) bytes += counter(host, "eth0", "tx_bytes");
    return bytes;
  }

  static std::optional<double> settled(const Process& process) {
    std::istringstream words(process.out());
    std::string word;
    double seconds = 0.0;
    if (!(words >> word >> seconds) || word != "settled") return std::nullopt;
    return seconds;
  }

  const std::vector<std::string> names_{"vehicle", "companion", "ground"};
};

TEST_P(ThirtyParticipants, KnowEachOtherWithinFiveSeconds) {
  if (GetParam().only_full && !full_tests()) GTEST_SKIP() << "set SWIFTLET_FULL_TESTS=1";
  make_three_hosts();
  if (IsSkipped()) return;
  std::optional<Process> server;
  if (GetParam().server) {
    server.emplace(start_command_on(
        "vehicle", {"fast-discovery-server", "-i", "0", "-l", "10.9.0.1", "-p", "11811", "-x",
                    SWIFTLET_SOURCE_DIR "/components/launch/discovery-server.xml"}));
  }
  std::vector<std::string> arguments{SWIFTLET_DISCOVERY_NODE, "--others",
                                     std::to_string(kHosts * kOnEach - 1)};
  arguments.insert(arguments.end(), GetParam().arguments.begin(), GetParam().arguments.end());
  const std::int64_t before = sent();
  std::vector<Process> nodes;
  for (int i = 0; i < kHosts * kOnEach; ++i) {
    nodes.push_back(
        start_command_on(names_[static_cast<std::size_t>(i) % names_.size()], arguments));
  }
  int known = 0;
  const bool all = becomes_true(kAllStarted, [&] {
    known = 0;
    for (const Process& node : nodes) known += settled(node) ? 1 : 0;
    return known == kHosts * kOnEach;
  });
  ASSERT_TRUE(all) << known << " know all others; one that does not: " << nodes.back().err();
  const std::int64_t after = sent();
  // From the moment at which a participant was there; those that started first waited for the last.
  double last = 0.0;
  double worst = 0.0;
  for (const Process& node : nodes) {
    worst = std::max(worst, *settled(node));
    last = *settled(node);
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto passed = [&] { return Seconds(std::chrono::steady_clock::now() - begin); };
  becomes_true(kQuiet * 2, [&] { return passed() >= kQuiet; });
  const double quiet = static_cast<double>(sent() - after) / passed().count();
  std::printf(
      "%-16s 30 participants on 3 hosts: known after %.2f s (the last to start %.2f s), "
      "%.0f kB to get there, then %.0f B/s\n",
      GetParam().name.c_str(), worst, last, static_cast<double>(after - before) / 1e3, quiet);
  RecordProperty("settled_s", fmt::format("{:.2f}", worst));
  RecordProperty("discovery_bytes", fmt::format("{}", after - before));
  RecordProperty("idle_bytes_per_s", fmt::format("{:.0f}", quiet));
  EXPECT_LT(worst, kSettleLimit.count() * kSlowdown);
  for (Process& node : nodes) node.send(SIGTERM);
  for (Process& node : nodes) EXPECT_TRUE(node.wait(kExitLimit)) << node.err();
}

INSTANTIATE_TEST_SUITE_P(
    By, ThirtyParticipants,
    testing::Values(Way{"Multicast", {"--network", "eth0"}},
                    Way{"DiscoveryServer", {"--discovery-server", "10.9.0.1:11811"}, true},
                    Way{"ServerOwnTopics",
                        {"--discovery-server", "10.9.0.1:11811", "--see-all", "false"},
                        true,
                        true}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace swiftlet::test
