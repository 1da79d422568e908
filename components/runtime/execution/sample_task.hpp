// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "components/runtime/execution/executor.hpp"

namespace swiftlet {

/// Takes the samples of a reader in a mailbox, one each time that one was said to have arrived, so
/// that samples of several readers are heard in the order in which they came. The last run that was
/// posted takes all that are there.
///
/// Fast DDS tells once of all samples that waited for one before them, which was lost and sent
/// again. Were one taken each time that it tells, all that come later would be late by as many
/// samples, for ever.
class SampleTask : public Task {
 public:
  explicit SampleTask(Mailbox& mailbox) : mailbox_(mailbox) {}

  /// A sample has arrived, or several. From any thread. `at_once`: see Mailbox::run_or_post.
  void arrived(bool at_once = false) {
    if (pending_.fetch_add(1) >= limit_) {
      pending_.fetch_sub(1);
    } else if (at_once) {
      mailbox_.run_or_post(*this);
    } else {
      mailbox_.post(*this);
    }
  }

  void run() final {
    const bool is_last = pending_.fetch_sub(1) == 1;
    bool took = take_one();
    for (int taken = 1; took && is_last && taken < limit_; ++taken) took = take_one();
  }

 protected:
  /// Hands the oldest sample on; false where there is none.
  virtual bool take_one() = 0;

  /// So many samples wait in the reader at most: more runs would find nothing.
  void set_limit(int samples) { limit_ = samples; }
  Mailbox& mailbox() { return mailbox_; }

 private:
  Mailbox& mailbox_;
  std::atomic<int> limit_{1};
  std::atomic<int> pending_{0};  // runs posted and not begun
};

}  // namespace swiftlet
