// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/rtps_wire.hpp"

#include <arpa/inet.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <initializer_list>
#include <map>

namespace swiftlet::fuzz {
namespace {

constexpr std::size_t kHeader = 20;           // 'RTPS', version, vendor, GUID prefix
constexpr std::size_t kSubmessageHeader = 4;  // id, flags, length
constexpr std::size_t kLargestDatagram = 65'507;
constexpr std::size_t kMostHeard = 5000;
constexpr std::size_t kAlike = 3;
constexpr std::size_t kMostSubmessages = 6;
constexpr std::uint8_t kLittleEndian = 1;

/// Where the UDP payload of an IPv4 packet begins; its end where it is none of RTPS.
std::size_t payload_of(const Bytes& packet) {
  const std::size_t ip = packet.empty() ? 0 : (packet[0] & 0xFU) * 4U;
  const std::size_t begin = ip + 8;
  if (packet.size() < begin + kHeader || packet[9] != IPPROTO_UDP) return packet.size();
  const std::uint8_t name[] = {'R', 'T', 'P', 'S'};
  const auto first = packet.begin() + static_cast<std::ptrdiff_t>(begin);
  return std::equal(std::begin(name), std::end(name), first) ? begin : packet.size();
}

std::size_t length_of(const Bytes& datagram, std::size_t at) {
  const std::size_t first = datagram[at + 2], second = datagram[at + 3];
  const bool little = (datagram[at + 1] & kLittleEndian) != 0;
  return little ? first + 256 * second : 256 * first + second;
}

/// Where the submessages of a sound datagram begin, and its end.
std::vector<std::size_t> bounds(const Bytes& datagram) {
  std::vector<std::size_t> bounds{kHeader};
  while (bounds.back() + kSubmessageHeader <= datagram.size()) {
    const std::size_t at = bounds.back();
    const std::size_t length = length_of(datagram, at);
    // Zero: to the end of the datagram.
    const std::size_t next = length == 0 ? datagram.size() : at + kSubmessageHeader + length;
    bounds.push_back(std::min(next, datagram.size()));
  }
  return bounds;
}

/// Sender, submessages with their flags, and about how long.
Bytes shape_of(const Bytes& datagram) {
  Bytes shape(datagram.begin() + 8, datagram.begin() + static_cast<std::ptrdiff_t>(kHeader));
  const auto all = bounds(datagram);
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    shape.push_back(datagram[all[i]]);
    shape.push_back(datagram[all[i] + 1]);
    shape.push_back(static_cast<std::uint8_t>((all[i + 1] - all[i]) / 16));
  }
  return shape;
}

/// A submessage with little-endian words as its body.
Bytes submessage(std::uint8_t id, std::initializer_list<std::uint32_t> words) {
  Bytes bytes{id, kLittleEndian, static_cast<std::uint8_t>(4 * words.size()), 0};
  for (const std::uint32_t word : words) {
    for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(word >> (8 * i)));
  }
  return bytes;
}

/// What two ends say to each other only when samples get lost, made for the ends of a HEARTBEAT or
/// an ACKNACK.
std::vector<Bytes> rare_beside(const Bytes& sound) {
  constexpr std::uint8_t kAckNack = 0x06, kHeartbeat = 0x07, kGap = 0x08, kNackFragments = 0x12,
                         kHeartbeatFragment = 0x13;
  if (sound.size() < 16 || (sound[0] != kHeartbeat && sound[0] != kAckNack)) return {};
  std::vector<Bytes> made{
      submessage(kGap, {0, 0, 0, 3, 0, 9, 40, 0xF0F0F0F0, 0xFF000000}),
      submessage(kHeartbeatFragment, {0, 0, 0, 5, 3, 1}),
      submessage(kNackFragments, {0, 0, 0, 1, 1, 3, 0xE0000000, 7}),
  };
  for (Bytes& bytes : made) std::copy_n(sound.begin() + 4, 8, bytes.begin() + 4);  // both entities
  return made;
}

}  // namespace

LoopbackCapture::LoopbackCapture()
    : socket_(socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, htons(ETH_P_IP))) {
  const int room = 32 << 20;
  if (ok()) setsockopt(socket_, SOL_SOCKET, SO_RCVBUFFORCE, &room, sizeof(room));
}
LoopbackCapture::~LoopbackCapture() {
  if (ok()) close(socket_);
}

std::vector<Bytes> LoopbackCapture::take() {
  std::vector<Bytes> heard;
  Bytes packet;
  while (heard.size() < kMostHeard) {
    packet.resize(1 << 17);
    sockaddr_ll from{};
    socklen_t size = sizeof(from);
    const ssize_t length = recvfrom(socket_, packet.data(), packet.size(), 0,
                                    reinterpret_cast<sockaddr*>(&from), &size);
    if (length < 0) break;
    if (from.sll_pkttype == PACKET_OUTGOING) continue;  // each comes twice on loopback
    packet.resize(static_cast<std::size_t>(length));
    packet.erase(packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(payload_of(packet)));
    if (!packet.empty()) heard.push_back(packet);
  }
  return heard;
}

RtpsMutator::RtpsMutator(const std::vector<Bytes>& heard) {
  std::map<Bytes, std::size_t> seen;
  for (const Bytes& datagram : heard) {
    if (++seen[shape_of(datagram)] > kAlike) continue;
    sound_.push_back(datagram);
    const auto all = bounds(datagram);
    const auto begin = datagram.begin();
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
      const Bytes header(begin, begin + kHeader);
      const Bytes submessage(begin + static_cast<std::ptrdiff_t>(all[i]),
                             begin + static_cast<std::ptrdiff_t>(all[i + 1]));
      submessages_.push_back({submessage, header});
      for (Bytes& rare : rare_beside(submessage)) submessages_.push_back({std::move(rare), header});
    }
  }
}

Bytes RtpsMutator::next(std::mt19937& random) const {
  if (random() % 2 == 0) return composed(random);
  const Bytes& seed = sound_[random() % sound_.size()];
  const Bytes& other = sound_[random() % sound_.size()];
  return mutated(seed, other, kLargestDatagram, random);
}

Bytes RtpsMutator::composed(std::mt19937& random) const {
  Bytes datagram = submessages_[random() % submessages_.size()].header;
  for (std::size_t left = 1 + random() % kMostSubmessages; left > 0; --left) {
    const Bytes& whole = submessages_[random() % submessages_.size()].bytes;
    const Bytes& other = submessages_[random() % submessages_.size()].bytes;
    // The body changes and the header tells of it, so that what reads the body gets to see it.
    Bytes body(whole.begin() + kSubmessageHeader, whole.end());
    if (random() % 4 != 0) body = mutated(body, other, kLargestDatagram, random);
    std::uint8_t id = whole[0], flags = whole[1];
    std::size_t length = body.size();
    if (random() % 16 == 0) id = static_cast<std::uint8_t>(random() % 0x20);
    if (random() % 8 == 0) flags ^= static_cast<std::uint8_t>(1U << (random() % 8));
    if (random() % 8 == 0) length += random() % 65 - 32;
    if (random() % 32 == 0) length = random();
    const bool little = (flags & kLittleEndian) != 0;
    const auto low = static_cast<std::uint8_t>(length);
    const auto high = static_cast<std::uint8_t>(length >> 8);
    datagram.insert(datagram.end(), {id, flags, little ? low : high, little ? high : low});
    datagram.insert(datagram.end(), body.begin(), body.end());
  }
  datagram.resize(std::min(datagram.size(), kLargestDatagram));
  return datagram;
}

DatagramSender::DatagramSender() : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  in_addr loopback{};
  loopback.s_addr = htonl(INADDR_LOOPBACK);
  setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof(loopback));
}
DatagramSender::~DatagramSender() {
  close(socket_);
}

void DatagramSender::send(const Bytes& bytes, std::uint32_t address, int port) const {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(address);
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof(to));
}

}  // namespace swiftlet::fuzz
