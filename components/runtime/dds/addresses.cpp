// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/addresses.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <map>
#include <memory>

#include "components/runtime/config/config.hpp"
#include "components/runtime/runtime_error.hpp"

namespace swiftlet {
namespace {

constexpr std::size_t kMaxPortDigits = 5;

std::string to_text(const in_addr& address) {
  char text[INET_ADDRSTRLEN] = "";
  inet_ntop(AF_INET, &address, text, sizeof(text));
  return text;
}

/// IPv4 addresses by name of the interface; none for one that has none, or is down.
std::map<std::string, std::vector<std::string>> local_interfaces() {
  std::map<std::string, std::vector<std::string>> interfaces;
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return interfaces;
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(all, &freeifaddrs);
  for (const ifaddrs* entry = all; entry != nullptr; entry = entry->ifa_next) {
    auto& addresses = interfaces[entry->ifa_name];
    const bool is_ipv4 = entry->ifa_addr != nullptr && entry->ifa_addr->sa_family == AF_INET;
    if (!is_ipv4 || (entry->ifa_flags & IFF_UP) == 0) continue;
    addresses.push_back(to_text(reinterpret_cast<const sockaddr_in*>(entry->ifa_addr)->sin_addr));
  }
  return interfaces;
}

std::string prefix(const std::string& option) {
  return option.empty() ? "" : option + " ";
}

sockaddr_in socket_address(const std::string& address) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(9);  // "discard": a datagram socket sends nothing by being connected
  inet_pton(AF_INET, address.c_str(), &result.sin_addr);
  return result;
}

}  // namespace

HostAndPort parse_host_and_port(const std::string& option, const std::string& text) {
  const std::size_t colon = text.find(':');
  HostAndPort result;
  result.host = text.substr(0, colon);
  if (result.host.empty()) {
    throw ConfigError(fmt::format("{}'{}': write ADDRESS or ADDRESS:PORT", prefix(option), text));
  }
  if (colon == std::string::npos) return result;
  const std::string port = text.substr(colon + 1);
  const bool is_number = !port.empty() && port.size() <= kMaxPortDigits &&
                         port.find_first_not_of("0123456789") == std::string::npos;
  if (!is_number || std::stoi(port) < 1 || std::stoi(port) > 65535) {
    throw ConfigError(fmt::format("{}'{}': '{}' is no port; it is a number from 1 to 65535",
                                  prefix(option), text, port));
  }
  result.port = std::stoi(port);
  return result;
}

std::string address_of_host(const std::string& option, const std::string& host) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host.c_str(), nullptr, &hints, &found);
  if (error != 0) {
    throw ConfigError(fmt::format("{}'{}': no IPv4 address is known for it ({}); give the address",
                                  prefix(option), host, gai_strerror(error)));
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
  return to_text(reinterpret_cast<const sockaddr_in*>(found->ai_addr)->sin_addr);
}

std::vector<std::string> addresses_of_interface(const std::string& name) {
  const auto interfaces = local_interfaces();
  const auto found = interfaces.find(name);
  if (found != interfaces.end()) {
    if (!found->second.empty()) return found->second;
    throw RuntimeError(fmt::format(
        "interface '{}' is there, but down or without an IPv4 address; set it up, or wait for it "
        "with --network-wait SECONDS",
        name));
  }
  std::string known;
  std::vector<std::string> names;
  for (const auto& [other, addresses] : interfaces) {
    names.push_back(other);
    known += fmt::format(
        "{}{} ({})", known.empty() ? "" : ", ", other,
        addresses.empty() ? "no address" : fmt::format("{}", fmt::join(addresses, ", ")));
    for (const std::string& address : addresses) {
      if (address == name) return {address};
    }
  }
  const std::string near = nearest_word(name, names);
  throw ConfigError(fmt::format(
      "--network {}: no interface of this host has that name or address; {}there are {}", name,
      near.empty() ? "" : fmt::format("did you mean '{}'? ", near), known));
}

std::string route_to(const std::string& option, const std::string& address) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const sockaddr_in remote = socket_address(address);
  sockaddr_in local{};
  socklen_t size = sizeof(local);
  const bool routed =
      connect(socket, reinterpret_cast<const sockaddr*>(&remote), sizeof(remote)) == 0 &&
      getsockname(socket, reinterpret_cast<sockaddr*>(&local), &size) == 0;
  const int error = errno;
  close(socket);
  if (!routed) {
    throw RuntimeError(fmt::format(
        "{}{}: this host has no route to it ({}); is the interface up? Name it with --network, or "
        "wait for it with --network-wait SECONDS",
        prefix(option), address, std::strerror(error)));
  }
  return to_text(local.sin_addr);
}

}  // namespace swiftlet
