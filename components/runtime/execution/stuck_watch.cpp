// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/execution/stuck_watch.hpp"

#include <atomic>
#include <deque>
#include <mutex>

namespace swiftlet {
namespace {

/// Where a thread is. Kept for the next thread when one ends.
struct Slot {
  std::atomic<const char*> what{nullptr};
  std::atomic<std::int64_t> since{0};  ///< number of the entry in this slot; 0: not inside
  std::int64_t entries = 0;            ///< of the thread that has it
  bool taken = false;                  ///< guarded by the table
};

class Table {
 public:
  Slot& take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (Slot& slot : slots_) {
      if (!slot.taken) return occupy(slot);
    }
    return occupy(slots_.emplace_back());
  }
  void give_back(Slot& slot) {
    const std::lock_guard<std::mutex> lock(mutex_);
    slot.taken = false;
  }
  template <class Visitor>
  void for_each(Visitor visit) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::size_t i = 0; i < slots_.size(); ++i) visit(i, slots_[i]);
  }

 private:
  static Slot& occupy(Slot& slot) {
    slot.taken = true;
    return slot;
  }
  std::mutex mutex_;
  std::deque<Slot> slots_;  // which stay where they are
};

/// Never destroyed: threads of the middleware may outlive main().
Table& table() {
  static auto* const table = new Table;
  return *table;
}

Slot& own_slot() {
  struct Holder {
    Slot& slot = table().take();
    ~Holder() { table().give_back(slot); }
  };
  thread_local Holder holder;
  return holder.slot;
}

}  // namespace

StuckWatch::Inside::Inside(const char* what) {
  Slot& slot = own_slot();
  outer_ = slot.what.load(std::memory_order_relaxed);
  outer_since_ = slot.since.load(std::memory_order_relaxed);
  slot.what.store(what, std::memory_order_relaxed);
  slot.since.store(++slot.entries, std::memory_order_release);
}

StuckWatch::Inside::~Inside() {
  Slot& slot = own_slot();
  slot.what.store(outer_, std::memory_order_relaxed);
  // Out of what was inside of something else is a step forward, too.
  slot.since.store(outer_since_ == 0 ? 0 : ++slot.entries, std::memory_order_release);
}

std::optional<std::string> StuckWatch::inside_since(int times) {
  std::optional<std::string> stuck;
  table().for_each([&](std::size_t place, Slot& slot) {
    if (place >= seen_.size()) seen_.resize(place + 1);
    Seen& seen = seen_[place];
    const std::int64_t since = slot.since.load(std::memory_order_acquire);
    if (since == 0 || since != seen.since) {
      seen = {since, since == 0 ? 0 : 1};
    } else if (++seen.times >= times) {
      stuck = slot.what.load(std::memory_order_relaxed);
    }
  });
  return stuck;
}

}  // namespace swiftlet
