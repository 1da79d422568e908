// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/latched_samples.hpp"

#include <algorithm>

namespace swiftlet {

void LatchedSamples::note(std::shared_ptr<const RecordedSample> sample) {
  const auto earlier = std::find_if(samples_.begin(), samples_.end(), [&](const auto& known) {
    return known->topic == sample->topic && known->writer == sample->writer;
  });
  if (earlier != samples_.end()) {
    bytes_ -= (*earlier)->memory();
    samples_.erase(earlier);
  }
  bytes_ += sample->memory();
  samples_.push_back(std::move(sample));
  while (bytes_ > max_bytes_) {
    bytes_ -= samples_.front()->memory();
    samples_.pop_front();
  }
}

std::vector<std::shared_ptr<const RecordedSample>> LatchedSamples::all() const {
  return {samples_.begin(), samples_.end()};
}

}  // namespace swiftlet
