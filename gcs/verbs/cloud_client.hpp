// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/surroundings/cloud_collector.hpp"
#include "components/terminal/terminal.hpp"
#include "components/topics.hpp"

namespace swiftlet {

/// What to listen to, and for how long.
struct CloudParams {
  std::string topic;  ///< of type PointCloud2; "": the laser scans
  Duration length = std::chrono::seconds(5);
  Duration patience = std::chrono::seconds(5);  ///< until the first
  double voxel = 0.05;                          ///< of each cube of so much one point is kept [m]
};

/// Gathers what is scanned for a while, from the first scan that could be placed on; then ends the
/// run with 0, or with 1 where there was none in time.
class CloudClient : public Component {
 public:
  CloudClient(const ComponentContext& context, const CloudParams& params, Terminal& terminal);

  bool done() const { return done_; }
  const CloudCollector& collector() const { return collector_; }
  /// Why there is no cloud, where it is not done; "" where it was interrupted.
  const std::string& problem() const { return problem_; }

 private:
  void advance(Time now);
  std::string why_nothing() const;

  CloudParams params_;
  Terminal& terminal_;
  CloudCollector collector_;
  Time begin_;
  std::optional<Time> first_;  // when something was placed
  bool done_ = false;
  std::string problem_;
};

}  // namespace swiftlet
