// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/runtime/dds/addresses.hpp"
#include "components/runtime/dds/network.hpp"
#include "components/runtime/runtime_error.hpp"

namespace swiftlet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

NetworkConfig parsed(const std::string& yaml) {
  const Config config = Config::parse(yaml, "network.yaml");
  const NetworkConfig network = read_network(config);
  config.finish();
  return network;
}

template <class Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(NetworkConfig, NothingLeavesTheMachineByDefault) {
  const NetworkConfig network;
  EXPECT_TRUE(network.loopback_only());
  EXPECT_THAT(addresses_of(network), ElementsAre("127.0.0.1"));
  EXPECT_THAT(to_arguments(network), ElementsAre());
}

TEST(NetworkConfig, PeersAndServersTakeThePlaceOfMulticastUnlessItIsAskedFor) {
  EXPECT_TRUE(parsed("interfaces: [lo]").uses_multicast());
  EXPECT_FALSE(parsed("peers: [127.0.0.1]").uses_multicast());
  EXPECT_FALSE(parsed("discovery_servers: ['127.0.0.1:11811']").uses_multicast());
  EXPECT_TRUE(parsed("{peers: [127.0.0.1], multicast: true}").uses_multicast());
  EXPECT_FALSE(parsed("{interfaces: [lo], multicast: false}").uses_multicast());
}

TEST(NetworkConfig, TheFileAndTheCommandLineSayTheSame) {
  const NetworkConfig network = parsed(
      "{interfaces: [eth0, eth1], peers: ['10.0.0.1:7410'], discovery_servers: ['a:1'], "
      "multicast: false, multicast_ttl: 4, wait: 2.5, max_datagram: 1400, pace: 9000, "
      "see_all: false}");
  EXPECT_THAT(to_arguments(network),
              ElementsAre("--network", "eth0", "--network", "eth1", "--peer", "10.0.0.1:7410",
                          "--discovery-server", "a:1", "--multicast", "false", "--multicast-ttl",
                          "4", "--network-wait", "2.5", "--max-datagram", "1400", "--pace", "9000",
                          "--see-all", "false"));
}

TEST(NetworkConfig, AHostsSectionIsOnTopOfTheSystems) {
  const NetworkConfig base = parsed("{interfaces: [eth0], multicast_ttl: 3}");
  const NetworkConfig network =
      read_network(Config::parse("interfaces: [wlan0]", "network.yaml"), base);
  EXPECT_THAT(network.interfaces, ElementsAre("wlan0"));
  EXPECT_EQ(network.multicast_ttl, 3);
}

TEST(NetworkConfig, InterfacesGoByNameOrAddress) {
  NetworkConfig network;
  network.interfaces = {"lo"};
  EXPECT_THAT(addresses_of(network), ElementsAre("127.0.0.1"));
  network.interfaces = {"127.0.0.1"};
  EXPECT_THAT(addresses_of(network), ElementsAre("127.0.0.1"));
  network.interfaces = {"loo"};
  const std::string text = refusal([&] { addresses_of(network); });
  EXPECT_THAT(text, HasSubstr("did you mean 'lo'?"));
  EXPECT_THAT(text, HasSubstr("lo (127.0.0.1)"));
}

TEST(NetworkConfig, APeerNamesTheInterfaceThatLeadsToIt) {
  NetworkConfig network;
  network.peers = {"127.0.0.9"};
  EXPECT_THAT(addresses_of(network), ElementsAre("127.0.0.1"));
}

TEST(NetworkConfig, BadValuesAreRefusedWithFileAndLine) {
  for (const char* yaml :
       {"peers: ['10.0.0.1:']", "peers: ['10.0.0.1:0']", "peers: [':7410']",
        "peers: ['10.0.0.1:65536']", "peers: ['10.0.0.1:7e3']", "discovery_servers: [10.0.0.1]",
        "max_datagram: 100", "max_datagram: 70000", "multicast_ttl: 256", "wait: -1",
        "multicast: maybe"}) {
    EXPECT_THAT(refusal([&] { parsed(yaml); }), HasSubstr("network.yaml:1")) << yaml;
  }
}

TEST(NetworkConfig, WaitingForAnInterfaceEndsWithTheReasonWhyItIsNotThere) {
  NetworkConfig network;
  network.interfaces = {"nowhere0"};
  network.wait = 0.3;
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(refusal([&] { wait_for_interfaces(network); }), HasSubstr("nowhere0"));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(300));
}

}  // namespace
}  // namespace swiftlet
