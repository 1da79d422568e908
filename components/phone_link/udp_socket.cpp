// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/phone_link/udp_socket.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

namespace swiftlet {
namespace {

/// A wait that is longer is no wait: somebody set the clock in between.
constexpr Duration kLongestWait = std::chrono::seconds(1);

sockaddr_in to_native(const UdpEndpoint& endpoint) {
  sockaddr_in native{};
  native.sin_family = AF_INET;
  native.sin_addr.s_addr = htonl(endpoint.address);
  native.sin_port = htons(endpoint.port);
  return native;
}

UdpEndpoint from_native(const sockaddr_in& native) {
  return {ntohl(native.sin_addr.s_addr), ntohs(native.sin_port)};
}

Duration to_duration(const timespec& time) {
  return std::chrono::seconds(time.tv_sec) + Duration(time.tv_nsec);
}

/// The kernel notes by the time of day when a datagram came.
Duration waited_since(msghdr& message) {
  for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr;
       part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec came{};
    std::memcpy(&came, CMSG_DATA(part), sizeof(came));
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    const Duration waited = to_duration(now) - to_duration(came);
    return waited < Duration(0) || waited > kLongestWait ? Duration(0) : waited;
  }
  return Duration(0);
}

}  // namespace

Result<UdpSocket> UdpSocket::open() {
  const int descriptor = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return Error{fmt::format("no UDP socket: {}", std::strerror(errno))};
  return UdpSocket(descriptor);
}

Result<UdpSocket> UdpSocket::listen(const UdpEndpoint& local) {
  auto opened = open();
  if (!opened) return opened;
  const int descriptor = opened->descriptor();
  const int on = 1;
  setsockopt(descriptor, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof(on));  // does without, too
  const sockaddr_in address = to_native(local);
  if (bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) {
    return opened;
  }
  const int reason = errno;
  return Error{fmt::format("cannot listen at {}: {}", to_string(local),
                           reason == EADDRINUSE      ? "another process does"
                           : reason == EADDRNOTAVAIL ? "this machine has no such address"
                                                     : std::strerror(reason))};
}

UdpSocket::UdpSocket(UdpSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

UdpSocket& UdpSocket::operator=(UdpSocket&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

UdpSocket::~UdpSocket() {
  if (descriptor_ >= 0) close(descriptor_);
}

Result<UdpSocket::Arrival> UdpSocket::receive(std::uint8_t* bytes, std::size_t room) {
  sockaddr_in sender{};
  iovec part{bytes, room};
  alignas(cmsghdr) char control[128];
  msghdr message{};
  message.msg_name = &sender;
  message.msg_namelen = sizeof(sender);
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof(control);
  const ssize_t size = recvmsg(descriptor_, &message, MSG_DONTWAIT | MSG_TRUNC);
  if (size < 0) {
    if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return Arrival{};
    return Error{fmt::format("cannot receive: {}", std::strerror(errno))};
  }
  return Arrival{static_cast<std::size_t>(size), from_native(sender), waited_since(message)};
}

Status UdpSocket::send(const std::uint8_t* bytes, std::size_t size, const UdpEndpoint& to) {
  const sockaddr_in address = to_native(to);
  const ssize_t sent = sendto(descriptor_, bytes, size, 0,
                              reinterpret_cast<const sockaddr*>(&address), sizeof(address));
  if (sent >= 0 || errno == ECONNREFUSED) return {};
  return Error{fmt::format("cannot send to {}: {}", to_string(to), std::strerror(errno))};
}

}  // namespace swiftlet
