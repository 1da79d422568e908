// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/execution/background_work.hpp"

#include <sched.h>
#include <unistd.h>

#include <cassert>
#include <utility>

namespace swiftlet {
namespace {

constexpr int kNice = 10;  // a tenth of a processor that callbacks want, too: it never starves

}  // namespace

BackgroundWork::~BackgroundWork() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void BackgroundWork::begin(std::function<void()> work, std::function<void()> finish) {
  assert(idle());
  finish_ = std::move(finish);
  if (at_once_) {
    perform(std::move(work));
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    next_ = std::move(work);
  }
  changed_.notify_one();
  if (!thread_.joinable()) thread_ = std::thread([this] { serve(); });
}

void BackgroundWork::serve() {
  // A thread inherits its maker's scheduling; less may always be asked for.
  const sched_param ordinary{};
  (void)sched_setscheduler(0, SCHED_OTHER, &ordinary);
  (void)nice(kNice);  // of this thread alone
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return next_ != nullptr || ends_; });
    if (next_ == nullptr) return;
    auto work = std::exchange(next_, nullptr);
    lock.unlock();
    perform(std::move(work));
    lock.lock();
  }
}

void BackgroundWork::perform(std::function<void()> work) {
  try {
    work();
  } catch (...) {
    error_ = std::current_exception();
  }
  work = nullptr;
  mailbox_.post(*this);
}

void BackgroundWork::run() {
  const auto finish = std::exchange(finish_, nullptr);
  if (error_ != nullptr) std::rethrow_exception(std::exchange(error_, nullptr));
  finish();
}

}  // namespace swiftlet
