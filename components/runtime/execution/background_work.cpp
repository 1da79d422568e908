// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/execution/background_work.hpp"

#include <sched.h>

#include <cassert>
#include <utility>

namespace swiftlet {

BackgroundWork::~BackgroundWork() {
  if (thread_.joinable()) thread_.join();
}

void BackgroundWork::begin(std::function<void()> work, std::function<void()> finish) {
  assert(idle());
  finish_ = std::move(finish);
  const auto guarded = [this, work = std::move(work)] {
    try {
      work();
    } catch (...) {
      error_ = std::current_exception();
    }
    mailbox_.post(*this);
  };
  if (at_once_) {
    guarded();
    return;
  }
  thread_ = std::thread([guarded] {
    // A thread inherits its maker's scheduling; less may always be asked for.
    const sched_param ordinary{};
    (void)sched_setscheduler(0, SCHED_OTHER, &ordinary);
    guarded();
  });
}

void BackgroundWork::run() {
  if (thread_.joinable()) thread_.join();
  const auto finish = std::exchange(finish_, nullptr);
  if (error_ != nullptr) std::rethrow_exception(std::exchange(error_, nullptr));
  finish();
}

}  // namespace swiftlet
