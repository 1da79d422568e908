// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <variant>

#include "components/bag/recorded_sample.hpp"
#include "estimation/basics/result.hpp"

namespace swiftlet {

/// Takes samples at once and hands them to a sink in a thread of its own, in their order, so that
/// compression and a slow disk do not hold up who receives them. What waits takes at most
/// `max_bytes`; samples from 64 kB on are refused an eighth before, so that a flood of pictures
/// does not crowd out what is small and matters more.
class BackgroundWriter {
 public:
  using Sink = std::function<Status(const RecordedSample&)>;
  using Job = std::function<Status()>;

  BackgroundWriter(std::uint64_t max_bytes, Sink sink);
  /// Finishes what waits.
  ~BackgroundWriter();
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;

  /// False, with the sample dropped, where there is no room.
  bool offer(RecordedSample sample);
  /// Waits for room.
  void push(RecordedSample sample);
  /// Something else to do between the samples before it and those behind.
  void post(Job job);
  /// Waits until all is done.
  Status drain();

  /// The first error of sink or jobs. Nothing is done after it.
  Status failure() const;
  std::uint64_t queued_bytes() const;

 private:
  using Item = std::variant<RecordedSample, Job>;

  bool has_room(const RecordedSample& sample) const;
  void add(Item item, std::size_t bytes, bool urgent);
  void serve();
  void work(Item& item);

  const std::uint64_t max_bytes_;
  const Sink sink_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;   // there is something to do
  std::condition_variable moved_;  // something was done
  std::deque<Item> queue_;
  std::uint64_t queued_bytes_ = 0;
  bool urgent_ = false;  // somebody waits
  bool busy_ = false;
  bool finished_ = false;
  Status failure_;
  std::thread thread_;
};

}  // namespace swiftlet
