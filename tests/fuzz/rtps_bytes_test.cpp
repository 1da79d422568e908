// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Malformed RTPS datagrams at the UDP ports of a process.
#include <sched.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <optional>
#include <thread>

#include "components/runtime/dds/rtps_guard.hpp"
#include "tests/fuzz/rtps_wire.hpp"
#include "tests/system/system_test.hpp"

namespace swiftlet::test {
namespace {

using namespace std::chrono_literals;
using fuzz::Bytes;

constexpr std::uint32_t kLoopback = 0x7F000001;
constexpr std::uint32_t kGroup = 0xEFFF0001;  // 239.255.0.1
constexpr int kRate = 2000;                   // datagrams a second
constexpr double kMostGrowth = 64.0;          // [MB]

/// Resident memory [MB].
double memory_of(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/statm");
  double total = 0.0, resident = 0.0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

/// Two processes in a network of their own that talk with each other, and what they say.
class RtpsBytes : public SystemTest {
 protected:
  void SetUp() override {
    if (unshare(CLONE_NEWNET) != 0) GTEST_SKIP() << "making a network needs root";
    Process link = start_command({"ip", "link", "set", "lo", "up"});
    const auto linked = link.wait(kExitLimit);
    capture_.emplace();
    if (!linked || linked->exit_code != 0 || !capture_->ok()) {
      GTEST_SKIP() << "no network can be made here: " << link.err();
    }
    answerer_.emplace(start_peer("answer"));
    // The first in a network has the first ports.
    ASSERT_TRUE(becomes_true(kStartLimit, [&] { return !capture_->take().empty(); }));
    Process asker = start_peer("ask");
    ASSERT_TRUE(becomes_true(kStartLimit, [&] { return answers(asker) > 50; })) << asker.err();
    asker_.emplace(std::move(asker));
    const std::vector<Bytes> heard = capture_->take();
    RtpsGuard guard;
    for (const Bytes& sound : heard) {
      const char* problem = guard.judge(sound.data(), sound.size()).problem;
      ASSERT_EQ(problem, nullptr) << problem;
    }
    mutator_.emplace(heard);
    capture_.reset();
    ASSERT_GT(mutator_->sound(), 20U);
  }

  Process start_peer(const std::string& role) {
    return start_command({SWIFTLET_RTPS_PEER, std::to_string(domain()), role});
  }

  static int answers(const Process& asker) {
    const std::string out = asker.out();
    return static_cast<int>(std::count(out.begin(), out.end(), '\n'));
  }

  /// To the ports for discovery and for samples, at a bounded rate, while the process lives.
  void bombard(unsigned seed, int count) {
    const int first = 7400 + 250 * domain();  // RTPS 2.2, 9.6.1.1
    std::mt19937 random(seed);
    const fuzz::DatagramSender sender;
    auto next = std::chrono::steady_clock::now();
    for (int i = 0; i < count && answerer_->running(); ++i) {
      const Bytes datagram = mutator_->next(random);
      const auto choice = random() % 4;
      if (choice == 0) {
        sender.send(datagram, kGroup, first);
      } else {
        sender.send(datagram, kLoopback, first + (choice == 1 ? 10 : 11));
      }
      next += std::chrono::nanoseconds(1s) / kRate;
      std::this_thread::sleep_until(next);
    }
  }

  std::optional<fuzz::LoopbackCapture> capture_;
  std::optional<fuzz::RtpsMutator> mutator_;
  std::optional<Process> answerer_;
  std::optional<Process> asker_;
};

TEST_F(RtpsBytes, NeitherStopAProcessNorMakeItGrow) {
  const int count = full_tests() ? 50'000 : 8'000;
  for (unsigned seed = 1; seed <= (full_tests() ? 5 : 1); ++seed) {
    const double before = memory_of(answerer_->id());
    bombard(seed, count);
    ASSERT_TRUE(answerer_->running()) << "seed " << seed << ": " << answerer_->err();
    const double after = memory_of(answerer_->id());
    RecordProperty("growth_mb_seed_" + std::to_string(seed), std::to_string(after - before));
    std::printf("seed %u: %.1f MB, then %.1f MB\n", seed, before, after);
    EXPECT_LT(after - before, kMostGrowth * kSlowdown);
  }
  // Those that it knew may have been slandered; somebody new is served.
  expect_end(*asker_, SIGTERM, 0);
  Process newcomer = start_peer("ask");
  EXPECT_TRUE(becomes_true(kStartLimit, [&] { return answers(newcomer) > 50; }))
      << newcomer.err() << answerer_->err();
  expect_end(newcomer, SIGTERM, 0);
  expect_end(*answerer_, SIGTERM, 0);
}

}  // namespace
}  // namespace swiftlet::test
