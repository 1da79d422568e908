// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// `run --rt`: every thread is scheduled as asked, and what is refused is said.
#include <sched.h>

#include <csignal>
#include <fstream>
#include <set>

#include "tests/system/system_test.hpp"

namespace swiftlet::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

/// The sanitizers make `mlockall` do nothing and succeed.
constexpr bool kLocksMemory = kSlowdown == 1;

class RealTime : public SystemTest {
 protected:
  /// A commander, told to be real-time; `as` goes before the command.
  Process start_real_time(const std::string& priority, Arguments as = {}) {
    const Arguments command{SWIFTLET_PROGRAM, "run", "commander", "--rt", priority};
    as.insert(as.end(), command.begin(), command.end());
    return start_command(as);
  }
  bool can_run(const Arguments& command) {
    Process process = start_command(command);
    const auto finished = process.wait(kExitLimit);
    return finished && finished->exit_code == 0;
  }
  /// It takes part, and so has all threads that it will have.
  void expect_serving(const Process& process) {
    EXPECT_TRUE(becomes_true(kStartLimit, [&] {
      return run({"gcs", "status"}, kStartLimit).exit_code == 0;
    })) << process.err();
  }
};

/// Policies and priorities of the threads of a process: "1 50" is SCHED_FIFO with 50.
std::multiset<std::string> schedules_of(pid_t process) {
  std::multiset<std::string> schedules;
  for (const auto& task :
       fs::directory_iterator(fs::path("/proc") / std::to_string(process) / "task")) {
    const pid_t thread = std::stoi(task.path().filename().string());
    sched_param param{};
    const int policy = sched_getscheduler(thread);
    if (policy < 0 || sched_getparam(thread, &param) != 0) continue;  // it has ended
    schedules.insert(std::to_string(policy) + " " + std::to_string(param.sched_priority));
  }
  return schedules;
}

long locked_kilobytes(pid_t process) {
  std::ifstream status(fs::path("/proc") / std::to_string(process) / "status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.rfind("VmLck:", 0) == 0) return std::stol(line.substr(6));
  }
  return -1;
}

TEST_F(RealTime, EveryThreadOfTheProcessIsScheduledAsAsked) {
  if (!can_run({"chrt", "-f", "1", "true"})) {
    GTEST_SKIP() << "needs the right to SCHED_FIFO (root, or CAP_SYS_NICE)";
  }
  Process process = start_real_time("7");
  expect_serving(process);
  EXPECT_THAT(process.err(), HasSubstr("real time: SCHED_FIFO, priority 7"));
  EXPECT_THAT(process.err(), HasSubstr("real time: memory is locked"));
  const auto schedules = schedules_of(process.id());
  EXPECT_GT(schedules.size(), 4u);
  EXPECT_EQ(schedules.count("1 7"), schedules.size()) << testing::PrintToString(schedules);
  if (kLocksMemory) {
    EXPECT_GT(locked_kilobytes(process.id()), 1000);
  }
  expect_end(process, SIGTERM, 0);
}

TEST_F(RealTime, WithoutTheRightItRunsAndSaysWhatToDo) {
  const Arguments unprivileged{"setpriv",    "--bounding-set",      "-sys_nice,-ipc_lock",
                               "--inh-caps", "-sys_nice,-ipc_lock", "prlimit",
                               "--rtprio=0", "--memlock=65536"};
  if (!can_run({"setpriv", "--bounding-set", "-sys_nice", "true"})) {
    GTEST_SKIP() << "needs root, to give rights up";
  }
  Process process = start_real_time("50", unprivileged);
  expect_serving(process);
  EXPECT_THAT(process.err(), HasSubstr("no SCHED_FIFO with priority 50"));
  EXPECT_THAT(process.err(), HasSubstr("CAP_SYS_NICE"));
  if (kLocksMemory) {
    EXPECT_THAT(process.err(), HasSubstr("memory is not locked"));
  }
  EXPECT_THAT(process.err(), Not(HasSubstr("SCHED_FIFO, priority")));
  const auto schedules = schedules_of(process.id());
  EXPECT_EQ(schedules.count("0 0"), schedules.size()) << testing::PrintToString(schedules);
  expect_end(process, SIGTERM, 0);
}

TEST_F(RealTime, APriorityThatThereIsNotIsRefused) {
  const Finished finished = run({"run", "commander", "--rt", "100"});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_THAT(finished.err, HasSubstr("--rt"));
}

}  // namespace
}  // namespace swiftlet::test
