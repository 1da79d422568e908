// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/phone_link/udp_receiver.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>

namespace swiftlet {

UdpReceiver::UdpReceiver(UdpSocket socket, std::function<Time()> clock,
                         std::function<void()> arrived)
    : socket_(std::move(socket)),
      clock_(std::move(clock)),
      arrived_(std::move(arrived)),
      stop_(eventfd(0, EFD_CLOEXEC)),
      ring_(kMost) {
  if (stop_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
  thread_ = std::thread([this] { run(); });
}

UdpReceiver::~UdpReceiver() {
  const std::uint64_t one = 1;
  while (write(stop_, &one, sizeof(one)) < 0 && errno == EINTR) {
  }
  thread_.join();
  close(stop_);
}

void UdpReceiver::run() {
  Datagram datagram;
  while (wait()) {
    const auto arrival = socket_.receive(datagram.bytes.data(), datagram.bytes.size());
    if (!arrival) {
      const std::lock_guard<std::mutex> lock(mutex_);
      failure_ = arrival.error().reason;
      return;
    }
    if (arrival->sender.port == 0) continue;  // nothing came after all
    datagram.size = std::min(arrival->size, datagram.bytes.size());
    datagram.sender = arrival->sender;
    datagram.arrival = clock_() - arrival->waited;
    keep(datagram);
    arrived_();
  }
}

/// False when it is time to end.
bool UdpReceiver::wait() const {
  pollfd sources[2] = {{socket_.descriptor(), POLLIN, 0}, {stop_, POLLIN, 0}};
  while (poll(sources, 2, -1) < 0 && errno == EINTR) {
  }
  return sources[1].revents == 0;
}

void UdpReceiver::keep(const Datagram& datagram) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (waiting_ == kMost) {
    first_ = (first_ + 1) % kMost;
    --waiting_;
    ++given_up_;
  }
  ring_[(first_ + waiting_++) % kMost] = datagram;
}

bool UdpReceiver::take(Datagram& datagram) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (waiting_ == 0) return false;
  datagram = ring_[first_];
  first_ = (first_ + 1) % kMost;
  --waiting_;
  return true;
}

std::uint64_t UdpReceiver::given_up() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return given_up_;
}

std::string UdpReceiver::failure() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return failure_;
}

}  // namespace swiftlet
