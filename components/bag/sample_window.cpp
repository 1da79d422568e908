// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/sample_window.hpp"

#include <utility>

namespace swiftlet {

SampleWindow::SampleWindow(Duration length, std::size_t max_bytes)
    : length_(static_cast<mcap::Timestamp>(length.count())),
      max_bytes_(max_bytes - max_bytes / 4),
      latched_(max_bytes / 4) {}

void SampleWindow::add(RecordedSample sample, bool latched) {
  const mcap::Timestamp begin = begin_at(sample.log_time);
  while (!entries_.empty() && entries_.front().sample->log_time < begin) {
    cut_short_ = false;
    drop_front();
  }
  bytes_ += sample.memory();
  entries_.push_back({std::make_shared<RecordedSample>(std::move(sample)), latched});
  while (bytes_ > max_bytes_) {
    cut_short_ = true;
    drop_front();
  }
}

void SampleWindow::drop_front() {
  Entry& front = entries_.front();
  bytes_ -= front.sample->memory();
  if (front.latched) latched_.note(std::move(front.sample));
  entries_.pop_front();
}

void SampleWindow::note(const LossLedger& losses, mcap::Timestamp now) {
  if (losses_.empty() || !(losses_.back().second == losses)) losses_.emplace_back(now, losses);
  // The last one from before the window says what the window began with.
  while (losses_.size() > 1 && losses_[1].first < begin_at(now)) losses_.pop_front();
}

SampleWindow::Content SampleWindow::content(mcap::Timestamp now) const {
  Content content;
  content.begin = begin_at(now);
  content.latched = latched_.all();
  for (const Entry& entry : entries_) {
    if (entry.sample->log_time >= content.begin) {
      content.samples.push_back(entry.sample);
    } else if (entry.latched) {
      content.latched.push_back(entry.sample);
    }
  }
  if (!content.samples.empty()) content.begin = content.samples.front()->log_time;
  if (!losses_.empty()) content.losses = since(losses_.front().second, losses_.back().second);
  return content;
}

}  // namespace swiftlet
