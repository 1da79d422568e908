// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/system/lossy_link.hpp"

#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <deque>
#include <random>
#include <system_error>
#include <vector>

namespace swiftlet::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kLargestPacket = 65536;
constexpr int kTurn = 20;  // so often the thread looks whether it is to end [ms]

struct Packet {
  Clock::time_point due;
  std::vector<char> bytes;
};

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// An interface of IP packets in the namespace that this thread is in; read and written by the
/// descriptor, wherever that goes.
int make_interface(const std::string& name) {
  const int device = open("/dev/net/tun", O_RDWR | O_CLOEXEC | O_NONBLOCK);
  if (device < 0) fail("/dev/net/tun");
  ifreq request{};
  request.ifr_flags = IFF_TUN | IFF_NO_PI;
  name.copy(request.ifr_name, IFNAMSIZ - 1);
  if (ioctl(device, TUNSETIFF, &request) < 0) {
    close(device);
    fail("the interface " + name);
  }
  return device;
}

/// The same in the namespace of a process. A thread of its own goes there: namespaces are a
/// thread's.
int make_interface_at(pid_t host, const std::string& name) {
  int device = -1;
  std::exception_ptr problem;
  std::thread there([&] {
    try {
      const std::string file = "/proc/" + std::to_string(host) + "/ns/net";
      const int space = open(file.c_str(), O_RDONLY | O_CLOEXEC);
      if (space < 0) fail(file);
      const int entered = setns(space, CLONE_NEWNET);
      close(space);
      if (entered < 0) fail("the network of process " + std::to_string(host));
      device = make_interface(name);
    } catch (...) {
      problem = std::current_exception();
    }
  });
  there.join();
  if (problem) std::rethrow_exception(problem);
  return device;
}

}  // namespace

LossyLink::LossyLink(const std::array<End, 2>& ends, const Params& params) : params_(params) {
  for (std::size_t i = 0; i < ends.size(); ++i) {
    interfaces_[i] = make_interface_at(ends[i].host, params.interface);
    const std::string line =
        "nsenter --target " + std::to_string(ends[i].host) + " --net sh -c 'ip addr add " +
        ends[i].address + " dev " + params.interface + " && ip link set " + params.interface +
        " multicast on up && ip route add 224.0.0.0/4 dev " + params.interface + "'";
    if (std::system(line.c_str()) != 0) fail("not done: " + line);
  }
  thread_ = std::thread([this] { carry(); });
}

LossyLink::~LossyLink() {
  ends_ = true;
  if (thread_.joinable()) thread_.join();
  for (const int device : interfaces_) {
    if (device >= 0) close(device);
  }
}

void LossyLink::carry() {
  std::mt19937 random(params_.seed);
  std::bernoulli_distribution is_lost(params_.loss);
  std::array<std::deque<Packet>, 2> flying;  // that came in at this end
  std::vector<char> buffer(kLargestPacket);
  while (!ends_) {
    Clock::time_point next = Clock::now() + std::chrono::milliseconds(kTurn);
    for (const auto& way : flying) {
      if (!way.empty()) next = std::min(next, way.front().due);
    }
    const auto wait = std::chrono::ceil<std::chrono::milliseconds>(next - Clock::now()).count();
    std::array<pollfd, 2> waits{{{interfaces_[0], POLLIN, 0}, {interfaces_[1], POLLIN, 0}}};
    poll(waits.data(), waits.size(), std::max(0, static_cast<int>(wait)));
    for (std::size_t i = 0; i < 2; ++i) {
      for (ssize_t size; (size = read(interfaces_[i], buffer.data(), buffer.size())) > 0;) {
        if (is_cut_ || is_lost(random)) {
          ++lost_;
        } else {
          flying[i].push_back(
              {Clock::now() + params_.delay, {buffer.begin(), buffer.begin() + size}});
        }
      }
      for (; !flying[i].empty() && flying[i].front().due <= Clock::now(); flying[i].pop_front()) {
        const std::vector<char>& bytes = flying[i].front().bytes;
        // One that the far end does not take is lost, as on any wire.
        ++(write(interfaces_[1 - i], bytes.data(), bytes.size()) < 0 ? lost_ : carried_);
      }
    }
  }
}

}  // namespace swiftlet::test
