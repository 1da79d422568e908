// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "components/runtime/config/config.hpp"

namespace eprosima::fastdds::dds {
class DomainParticipantQos;
}

namespace swiftlet {

/// Which interfaces a process uses, and how it finds the others. The code, the section `network` of
/// a YAML file and the command line all fill in this one struct.
///
/// Nothing named: this machine alone, on its loopback interface. With interfaces: others are found
/// by multicast on them. With peers: by unicast to these. With discovery servers: through these.
struct NetworkConfig {
  /// Names ("eth0") or IPv4 addresses of this host. Where only peers or servers are named, the
  /// interfaces that the routes to them take.
  std::vector<std::string> interfaces;
  /// Hosts to be found by unicast: "ADDRESS" asks for the first 16 participants of that host,
  /// "ADDRESS:PORT" for one. A host name will do for an address.
  std::vector<std::string> peers;
  /// "ADDRESS:PORT" of each `fastdds discovery`; the first has --server-id 0, the next 1, ...
  std::vector<std::string> discovery_servers;
  /// Also announce by multicast. Not given: only where neither peers nor servers are named.
  std::optional<bool> multicast;
  int multicast_ttl = 1;  ///< routers that an announcement passes, and one
  /// How long an interface that is not there yet is waited for, before the start is given up [s].
  double wait = 0.0;
  /// Largest UDP datagram [byte], 0 for the largest there is (64 kB). Datagrams above the link's
  /// MTU are lost whole when one of their fragments is: name about 1400 for a link that loses.
  int max_datagram = 0;
  /// Samples above 64 kB are sent no faster than this [byte/s]; 0: as fast as it goes.
  int pace = 0;
  /// Whether a process hears through a discovery server of all topics, or only of its own. What
  /// shows the graph, records or relays needs all; it costs some discovery traffic at the start.
  bool see_all = true;

  /// Whether anything leaves this machine.
  bool loopback_only() const {
    return interfaces.empty() && peers.empty() && discovery_servers.empty();
  }
  bool uses_multicast() const {
    return multicast.value_or(peers.empty() && discovery_servers.empty());
  }
};

/// The section `network` of a file, on top of `base`. Throws ConfigError.
NetworkConfig read_network(const Config& section, const NetworkConfig& base = {});

/// The same as options of the command line: {"--network", "eth0", "--peer", ...}.
std::vector<std::string> to_arguments(const NetworkConfig& network);

/// IPv4 addresses that sockets are bound to, loopback first: what stays on this machine then goes
/// on whatever becomes of the other interfaces. Throws ConfigError where an interface, a peer or a
/// server cannot be there, and says what is; RuntimeError where one that is known is not up.
std::vector<std::string> addresses_of(const NetworkConfig& network);

/// Returns as soon as addresses_of() does, after `network.wait` at most; then throws as it does.
void wait_for_interfaces(const NetworkConfig& network);

/// Name in a participant of what paces large samples.
inline constexpr const char* kPacing = "swiftlet_pacing";

/// Fills in what `network` says of transports and discovery.
void apply(const NetworkConfig& network, int domain,
           eprosima::fastdds::dds::DomainParticipantQos& qos);

}  // namespace swiftlet
