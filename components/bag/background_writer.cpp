// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/background_writer.hpp"

#include <chrono>
#include <utility>

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kLarge = 64 << 10;
/// The thread sleeps until so much is there, or so long: to be woken for each of many small samples
/// would cost more than to write them.
constexpr std::uint64_t kWorthWaking = 256 << 10;
constexpr auto kLongestWait = 20ms;

}  // namespace

BackgroundWriter::BackgroundWriter(std::uint64_t max_bytes, Sink sink)
    : max_bytes_(max_bytes), sink_(std::move(sink)), thread_([this] { serve(); }) {}

BackgroundWriter::~BackgroundWriter() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    finished_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

bool BackgroundWriter::has_room(const RecordedSample& sample) const {
  if (queued_bytes_ == 0) return true;  // one that is larger than all room must pass alone
  const std::uint64_t limit =
      sample.data.size() < kLarge ? max_bytes_ : max_bytes_ - max_bytes_ / 8;
  return queued_bytes_ + sample.memory() <= limit;
}

void BackgroundWriter::add(Item item, std::size_t bytes, bool urgent) {
  const bool was_awake = urgent_ || queued_bytes_ >= kWorthWaking;
  queue_.push_back(std::move(item));
  queued_bytes_ += bytes;
  urgent_ = urgent_ || urgent;
  if (!was_awake && (urgent_ || queued_bytes_ >= kWorthWaking)) wake_.notify_one();
}

bool BackgroundWriter::offer(RecordedSample sample) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!has_room(sample)) return false;
  const std::size_t bytes = sample.memory();
  add(std::move(sample), bytes, false);
  return true;
}

void BackgroundWriter::push(RecordedSample sample) {
  std::unique_lock<std::mutex> lock(mutex_);
  moved_.wait(lock, [&] { return has_room(sample); });
  const std::size_t bytes = sample.memory();
  add(std::move(sample), bytes, false);
}

void BackgroundWriter::post(Job job) {
  const std::lock_guard<std::mutex> lock(mutex_);
  add(std::move(job), 0, true);
}

Status BackgroundWriter::drain() {
  std::unique_lock<std::mutex> lock(mutex_);
  urgent_ = true;
  wake_.notify_one();
  moved_.wait(lock, [this] { return queue_.empty() && !busy_; });
  return failure_;
}

Status BackgroundWriter::failure() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return failure_;
}

std::uint64_t BackgroundWriter::queued_bytes() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return queued_bytes_;
}

void BackgroundWriter::serve() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    wake_.wait_for(lock, kLongestWait,
                   [this] { return finished_ || urgent_ || queued_bytes_ >= kWorthWaking; });
    urgent_ = false;
    while (!queue_.empty()) {
      Item item = std::move(queue_.front());
      queue_.pop_front();
      const auto* sample = std::get_if<RecordedSample>(&item);
      const std::size_t bytes = sample == nullptr ? 0 : sample->memory();
      busy_ = true;
      lock.unlock();
      work(item);
      lock.lock();
      busy_ = false;
      queued_bytes_ -= bytes;
      moved_.notify_all();
    }
    moved_.notify_all();
    if (finished_) return;
  }
}

void BackgroundWriter::work(Item& item) {
  if (!failure().ok()) return;
  const auto* sample = std::get_if<RecordedSample>(&item);
  const Status done = sample != nullptr ? sink_(*sample) : std::get<Job>(item)();
  if (done.ok()) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  failure_ = done;
}

}  // namespace swiftlet
