// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Frames between processes, and within one: where they lie, and what a killed process leaves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "components/runtime/dds/shared_memory.hpp"
#include "components/runtime/host.hpp"
#include "tests/components/runtime/dds/frame_peer.hpp"
#include "tests/system/process.hpp"

namespace swiftlet::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using nlohmann::json;
using ::testing::PrintToString;

constexpr int kDomain = 79;
constexpr Seconds kLimit(30.0);

class Frames : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "frame_test_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  Process start(const std::vector<std::string>& arguments) {
    std::vector<std::string> command{SWIFTLET_FRAME_PEER, std::to_string(kDomain)};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return Process(command, {}, folder_ / std::to_string(++started_));
  }

  static ParticipantOptions options() {
    ParticipantOptions options;
    options.name = "frame_test";
    options.domain = kDomain;
    return options;
  }

  /// Publishes a frame every `period` until the other process has ended; what that one says.
  json publish_to(const std::vector<std::string>& arguments, Duration period = 5ms) {
    Participant participant(options());
    const auto writer = participant.make_writer(frame_spec("writer"));
    Process reader = start(arguments);
    std::uint32_t number = 0;
    const auto deadline = std::chrono::steady_clock::now() + 60s * kSlowdown;
    while (reader.running() && std::chrono::steady_clock::now() < deadline) {
      if (void* memory = writer->loan()) {
        fill(number++, *static_cast<Frame*>(memory));
        writer->write_loan(memory);
      }
      std::this_thread::sleep_for(period);
    }
    const auto finished = reader.wait(kLimit);
    EXPECT_TRUE(finished && finished->exit_code == 0) << reader.err();
    std::istringstream lines(reader.out());
    std::string line, last;
    while (std::getline(lines, line)) last = line;
    return json::parse(last, nullptr, false);
  }

  fs::path folder_;
  int started_ = 0;
};

TEST_F(Frames, AnotherProcessReadsThemWhereTheyWereWritten) {
  const json seen = publish_to({"objects", "50"});
  EXPECT_EQ(seen["whole"], 50) << seen;
  EXPECT_EQ(seen["shared"], 50) << seen;
  EXPECT_EQ(seen["overwritten"], 0) << seen;
}

TEST_F(Frames, ARecorderInAnotherProcessGetsTheirCdr) {
  const json seen = publish_to({"bytes", "50"});
  EXPECT_EQ(seen["whole"], 50) << seen;
}

TEST_F(Frames, AReaderThatDoesNotShareGetsCopies) {
  const json seen = publish_to({"copies", "50"});
  EXPECT_EQ(seen["whole"], 50) << seen;
  EXPECT_EQ(seen["shared"], 0) << seen;
}

TEST_F(Frames, OneThatIsOverwrittenWhileItIsReadIsNoticed) {
  const json seen = publish_to({"slow", "5"});
  // 100 ms for a callback, 5 ms for a frame, and 8 places for frames.
  EXPECT_GT(seen["overwritten"], 0) << seen;
  EXPECT_EQ(seen["overwritten"], seen["changed"]) << seen;
}

TEST_F(Frames, KilledProcessesLeaveNoMemoryBehindAndBlockNobody) {
  const auto files_of = [](const std::vector<std::string>& prefixes) {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(kSharedMemory)) {
      const std::string name = entry.path().filename();
      for (const std::string& prefix : prefixes) {
        if (name.find(prefix) != name.npos) found.push_back(name);
      }
    }
    return found;
  };
  std::vector<std::string> dead;
  for (int round = 0; round < 20; ++round) {
    Process publisher = start({"publish"});
    Process reader = start({"objects", "3"});
    const auto finished = reader.wait(kLimit);
    ASSERT_TRUE(finished && finished->exit_code == 0) << "round " << round << reader.err();
    Process killed_reader = start({"objects", "1000000"});
    ASSERT_TRUE(becomes_true(kLimit, [&] { return !killed_reader.out().empty(); }));
    const auto first_line = [](const Process& process) {
      const std::string out = process.out();
      return out.substr(0, out.find('\n'));
    };
    // Whoever died in an earlier round is gone since one of this round started. (Any other process
    // of this machine may be at it too, and be half done.)
    EXPECT_TRUE(becomes_true(kLimit, [&] { return files_of(dead).empty(); }))
        << "round " << round << PrintToString(files_of(dead));
    dead = {first_line(publisher), first_line(killed_reader)};
    ASSERT_EQ(dead[0].size(), 35u) << "not a GUID prefix: " << dead[0];
    ASSERT_GE(files_of(dead).size(), 3u) << "the test does not see the segments";
    publisher.send(SIGKILL);
    killed_reader.send(SIGKILL);
    ASSERT_TRUE(publisher.wait(kLimit) && killed_reader.wait(kLimit));
  }
  const Participant next(options());
  EXPECT_TRUE(becomes_true(kLimit, [&] { return files_of(dead).empty(); }))
      << PrintToString(files_of(dead));
}

TEST_F(Frames, UnusedLoansGiveTheirMemoryBackAndTooManyAreCopies) {
  Participant participant(options());
  const std::shared_ptr<Writer> writer = participant.make_writer(frame_spec("writer"));
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(Loan<Frame>(writer).in_place()) << i;

  const auto reader = participant.make_reader(frame_spec("reader"), [] {});
  ASSERT_TRUE(becomes_true(kLimit, [&] { return writer->matched_readers() == 1; }));
  Publisher<Frame> publisher(writer);
  std::vector<Loan<Frame>> loans;
  while (loans.size() < 1000 && (loans.empty() || loans.back().in_place())) {
    loans.push_back(publisher.loan());
  }
  ASSERT_FALSE(loans.back().in_place()) << "memory without end";
  Loan<Frame> last = std::move(loans.back());
  loans.clear();
  fill(7, *last);
  publisher.publish(std::move(last));
  bool arrived = false;
  ASSERT_TRUE(becomes_true(kLimit, [&] {
    return reader->take_in_place([&](const void* sample) {
      const auto& frame = *static_cast<const Frame*>(sample);
      arrived = frame.info().width() == 7 && is_whole(frame);
    });
  }));
  EXPECT_TRUE(arrived);
}

struct Camera : Component {
  explicit Camera(const ComponentContext& context)
      : Component(context), frames_(advertise(Topic<Frame>{"frames", qos::bulk})) {
    every(10ms, [this](Time) {
      if (sent.size() == 20) return stop(0);
      Loan<Frame> frame = frames_.loan();
      fill(static_cast<std::uint32_t>(sent.size()), *frame);
      sent.push_back(&*frame);
      frames_.publish(std::move(frame));
    });
  }
  Publisher<Frame> frames_;
  std::vector<const Frame*> sent;
};

struct Viewer : Component {
  explicit Viewer(const ComponentContext& context) : Component(context) {
    subscribe(Topic<Frame>{"frames", qos::bulk}, [this](const Frame& frame) {
      seen.push_back(&frame);
      whole += is_whole(frame) ? 1 : 0;
    });
    subscribe_raw("rt/frames", message_type<Frame>().dds_name(), qos::bulk, [this](const Cdr& cdr) {
      const auto frame = from_cdr<Frame>(cdr);
      recorded += frame.ok() && is_whole(*frame) ? 1 : 0;
    });
  }
  std::vector<const Frame*> seen;
  int whole = 0;
  int recorded = 0;
};

TEST_F(Frames, InLockstepTheCallbackGetsTheVeryMemoryThatWasLent) {
  HostOptions lockstep;
  lockstep.lockstep = true;
  Host host(lockstep);
  const Camera& camera = host.emplace<Camera>("camera");
  const Viewer& viewer = host.emplace<Viewer>("viewer");
  EXPECT_EQ(host.run(), 0);
  EXPECT_EQ(viewer.whole, 20);
  EXPECT_EQ(viewer.recorded, 20);
  EXPECT_EQ(viewer.seen, camera.sent);
}

}  // namespace
}  // namespace swiftlet::test
