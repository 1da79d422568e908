// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/execution/sample_task.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <vector>

namespace swiftlet {
namespace {

using testing::ElementsAre;

/// Keeps what is posted until it is served.
struct HeldMailbox : Mailbox {
  std::deque<Task*> tasks;
  void post(Task& task) override { tasks.push_back(&task); }
  void every(Duration, std::function<void(Time)>) override {}
  void call_at(Time, std::function<void(Time)>) override {}
  void halt() override {}
  void serve_one() {
    Task* task = tasks.front();
    tasks.pop_front();
    task->run();
  }
};

/// A reader whose samples are numbers; what is taken goes to a list that others write, too.
struct NumberTask : SampleTask {
  NumberTask(Mailbox& mailbox, std::vector<int>& list, int limit)
      : SampleTask(mailbox), taken(list) {
    set_limit(limit);
  }
  bool take_one() override {
    if (waiting.empty()) return false;
    taken.push_back(waiting.front());
    waiting.pop_front();
    return true;
  }
  std::deque<int> waiting;
  std::vector<int>& taken;
};

TEST(SampleTask, HearsSamplesOfTwoReadersInTheOrderInWhichTheyArrived) {
  HeldMailbox mailbox;
  std::vector<int> taken;
  NumberTask a(mailbox, taken, 10), b(mailbox, taken, 10);
  for (const auto& [task, number] : {std::pair{&a, 1}, {&b, 2}, {&a, 3}, {&a, 4}, {&b, 5}}) {
    task->waiting.push_back(number);
    task->arrived();
  }
  while (!mailbox.tasks.empty()) mailbox.serve_one();
  EXPECT_THAT(taken, ElementsAre(1, 2, 3, 4, 5));
}

TEST(SampleTask, OneNoticeOfManySamplesLeavesNoneBehind) {
  HeldMailbox mailbox;
  std::vector<int> taken;
  NumberTask task(mailbox, taken, 10);
  task.waiting = {1, 2, 3, 4};  // three that waited for the first
  task.arrived();
  mailbox.serve_one();
  EXPECT_THAT(taken, ElementsAre(1, 2, 3, 4));
  task.waiting = {5};
  task.arrived();
  mailbox.serve_one();
  EXPECT_EQ(taken.back(), 5) << "none is late";
}

TEST(SampleTask, NoMoreRunsWaitThanSamplesHaveRoom) {
  HeldMailbox mailbox;
  std::vector<int> taken;
  NumberTask task(mailbox, taken, 3);
  for (int number = 1; number <= 20; ++number) {
    task.waiting.push_back(number);
    if (task.waiting.size() > 3) task.waiting.pop_front();
    task.arrived();
  }
  EXPECT_EQ(mailbox.tasks.size(), 3U);
  while (!mailbox.tasks.empty()) mailbox.serve_one();
  EXPECT_THAT(taken, ElementsAre(18, 19, 20));
}

}  // namespace
}  // namespace swiftlet
