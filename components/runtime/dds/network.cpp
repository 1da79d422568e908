// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/network.hpp"

#include <fastdds/rtps/attributes/ServerAttributes.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fmt/format.h>
#include <fastdds/rtps/flowcontrol/FlowControllerDescriptor.hpp>

#include <algorithm>
#include <chrono>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <thread>

#include "components/runtime/dds/addresses.hpp"
#include "components/runtime/log.hpp"
#include "components/runtime/runtime_error.hpp"

namespace swiftlet {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

namespace {

constexpr const char* kLoopback = "127.0.0.1";
constexpr const char* kMulticastGroup = "239.255.0.1";  // of RTPS 2.2, 9.6.1.4
/// Participants of this machine, and of each peer, that are found by unicast. Every announcement is
/// sent to each of them, so the number for peers is a matter of what the wire bears.
constexpr int kLocalParticipants = 32;
constexpr int kParticipantsOfPeer = 16;
constexpr std::uint32_t kSocketBuffer = 4 << 20;
constexpr std::uint64_t kPacingPeriodMs = 50;
constexpr int kSmallestDatagram = 576;   // what every IPv4 host takes
constexpr int kLargestDatagram = 65500;  // of UDP, as Fast DDS has it

rtps::Locator_t locator(const std::string& address, int port) {
  rtps::Locator_t result;
  rtps::IPLocator::createLocator(LOCATOR_KIND_UDPv4, address, static_cast<std::uint32_t>(port),
                                 result);
  return result;
}

void add_transport(const NetworkConfig& network, dds::DomainParticipantQos& qos) {
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = addresses_of(network);
  udp->maxInitialPeersRange = kLocalParticipants;
  udp->sendBufferSize = kSocketBuffer;
  udp->receiveBufferSize = kSocketBuffer;
  udp->TTL = static_cast<std::uint8_t>(network.multicast_ttl);
  if (network.max_datagram > 0) {
    udp->maxMessageSize = static_cast<std::uint32_t>(network.max_datagram);
  }
  // UDP alone. No shared-memory transport: its segments outlive a killed process and can block the
  // next start.
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
}

/// Fast DDS's own list takes "address:port;address:port" and gives the servers the identities that
/// the program `fastdds discovery --server-id N` takes.
void add_servers(const NetworkConfig& network, rtps::DiscoverySettings& discovery) {
  std::vector<std::string> servers;
  for (const std::string& server : network.discovery_servers) {
    const HostAndPort place = parse_host_and_port("--discovery-server", server);
    servers.push_back(
        fmt::format("{}:{}", address_of_host("--discovery-server", place.host), *place.port));
  }
  eprosima::fastdds::rtps::load_environment_server_info(fmt::format("{}", fmt::join(servers, ";")),
                                                        discovery.m_DiscoveryServers);
  discovery.discoveryProtocol =
      network.see_all ? rtps::DiscoveryProtocol_t::SUPER_CLIENT : rtps::DiscoveryProtocol_t::CLIENT;
}

void add_peer(const std::string& peer, int domain, dds::DomainParticipantQos& qos) {
  const HostAndPort place = parse_host_and_port("--peer", peer);
  const std::string address = address_of_host("--peer", place.host);
  auto& peers = qos.wire_protocol().builtin.initialPeersList;
  if (place.port) peers.push_back(locator(address, *place.port));
  for (int i = 0; !place.port && i < kParticipantsOfPeer; ++i) {
    const std::uint32_t port = qos.wire_protocol().port.getUnicastPort(
        static_cast<std::uint32_t>(domain), static_cast<std::uint32_t>(i));
    peers.push_back(locator(address, static_cast<int>(port)));
  }
}

}  // namespace

NetworkConfig read_network(const Config& section, const NetworkConfig& base) {
  NetworkConfig network = base;
  section.read("interfaces", network.interfaces);
  section.read("peers", network.peers);
  section.read("discovery_servers", network.discovery_servers);
  if (section.has("multicast")) section.read("multicast", network.multicast.emplace());
  section.read("multicast_ttl", network.multicast_ttl, {0, 255});
  section.read("wait", network.wait, {0.0, 3600.0});
  section.read("max_datagram", network.max_datagram, {0, kLargestDatagram});
  section.read("pace", network.pace, {0, 1e9});
  section.read("see_all", network.see_all);
  if (network.max_datagram > 0 && network.max_datagram < kSmallestDatagram) {
    section.fail("max_datagram",
                 fmt::format("'max_datagram' must be 0 (no limit) or at least {}, not {}",
                             kSmallestDatagram, network.max_datagram));
  }
  const auto check = [&section](const char* key, const std::string& value) {
    try {
      parse_host_and_port("", value);
    } catch (const ConfigError& error) {
      section.fail(key, error.what());
    }
  };
  for (const std::string& peer : network.peers) check("peers", peer);
  for (const std::string& server : network.discovery_servers) {
    check("discovery_servers", server);
    if (!parse_host_and_port("", server).port) {
      section.fail("discovery_servers", fmt::format("'{}' needs a port: {}:11811", server, server));
    }
  }
  return network;
}

std::vector<std::string> to_arguments(const NetworkConfig& network) {
  const NetworkConfig standard;
  std::vector<std::string> arguments;
  const auto add = [&arguments](const char* option, const std::string& value) {
    arguments.insert(arguments.end(), {option, value});
  };
  for (const std::string& interface : network.interfaces) add("--network", interface);
  for (const std::string& peer : network.peers) add("--peer", peer);
  for (const std::string& server : network.discovery_servers) add("--discovery-server", server);
  if (network.multicast) add("--multicast", *network.multicast ? "true" : "false");
  if (network.multicast_ttl != standard.multicast_ttl) {
    add("--multicast-ttl", std::to_string(network.multicast_ttl));
  }
  if (network.wait != standard.wait) add("--network-wait", fmt::format("{}", network.wait));
  if (network.max_datagram != standard.max_datagram) {
    add("--max-datagram", std::to_string(network.max_datagram));
  }
  if (network.pace != standard.pace) add("--pace", std::to_string(network.pace));
  if (network.see_all != standard.see_all) add("--see-all", network.see_all ? "true" : "false");
  return arguments;
}

std::vector<std::string> addresses_of(const NetworkConfig& network) {
  std::vector<std::string> addresses{kLoopback};
  const auto add = [&addresses](const std::string& address) {
    const bool known = std::find(addresses.begin(), addresses.end(), address) != addresses.end();
    if (!known) addresses.push_back(address);
  };
  for (const std::string& interface : network.interfaces) {
    for (const std::string& address : addresses_of_interface(interface)) add(address);
  }
  const auto check = [&](const char* option, const std::string& remote) {
    const HostAndPort place = parse_host_and_port(option, remote);
    const std::string address = address_of_host(option, place.host);
    if (network.interfaces.empty()) add(route_to(option, address));
  };
  for (const std::string& peer : network.peers) check("--peer", peer);
  for (const std::string& server : network.discovery_servers) check("--discovery-server", server);
  return addresses;
}

void wait_for_interfaces(const NetworkConfig& network) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(network.wait);
  bool told = false;
  while (true) {
    try {
      addresses_of(network);
      return;
    } catch (const std::runtime_error& error) {
      if (std::chrono::steady_clock::now() >= end) throw;
      if (!std::exchange(told, true)) {
        logger("network")->warn("{}; waiting {} s at most", error.what(), network.wait);
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
}

void apply(const NetworkConfig& network, int domain, dds::DomainParticipantQos& qos) {
  add_transport(network, qos);
  auto& builtin = qos.wire_protocol().builtin;
  auto& discovery = builtin.discovery_config;
  using eprosima::fastrtps::Duration_t;
  discovery.leaseDuration = Duration_t(6, 0);
  discovery.leaseDuration_announcementperiod = Duration_t(1, 500'000'000);
  discovery.initial_announcements.count = 10;
  discovery.initial_announcements.period = Duration_t(0, 50'000'000);
  discovery.discoveryServer_client_syncperiod = Duration_t(0, 250'000'000);

  if (!network.discovery_servers.empty()) {
    add_servers(network, discovery);
  } else {
    // Unicast to the first participants of this machine: loopback has no multicast route
    // everywhere.
    builtin.initialPeersList.push_back(locator(kLoopback, 0));
    for (const std::string& peer : network.peers) add_peer(peer, domain, qos);
  }
  if (network.uses_multicast()) {
    // With its port: Fast DDS 2.9 takes port 0 for the unicast ports of participants here, too.
    const std::uint32_t port =
        qos.wire_protocol().port.getMulticastPort(static_cast<std::uint32_t>(domain));
    builtin.initialPeersList.push_back(locator(kMulticastGroup, static_cast<int>(port)));
  } else {
    // A unicast locator of our own (any address, the usual port) keeps Fast DDS from joining the
    // multicast group.
    rtps::Locator_t any;
    any.kind = LOCATOR_KIND_UDPv4;
    builtin.metatrafficUnicastLocatorList.push_back(any);
  }
  if (network.pace > 0) {
    auto pacing = std::make_shared<eprosima::fastdds::rtps::FlowControllerDescriptor>();
    pacing->name = kPacing;
    pacing->max_bytes_per_period =
        std::max<int>(1, static_cast<int>(network.pace * kPacingPeriodMs / 1000));
    pacing->period_ms = kPacingPeriodMs;
    qos.flow_controllers().push_back(pacing);
  }
}

}  // namespace swiftlet
