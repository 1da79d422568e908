// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <memory>
#include <vector>

#include "components/bag/recorded_sample.hpp"

namespace swiftlet {

/// The last sample of each writer of a latched topic (maps, static transforms): what a reader that
/// comes now would get from DDS. The oldest go where there are more than `max_bytes` of them.
class LatchedSamples {
 public:
  explicit LatchedSamples(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  void note(std::shared_ptr<const RecordedSample> sample);
  /// In the order in which they came.
  std::vector<std::shared_ptr<const RecordedSample>> all() const;

 private:
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::list<std::shared_ptr<const RecordedSample>> samples_;
};

}  // namespace swiftlet
