// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// What a flight in several processes looks like from outside, measured by the test itself.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "components/runtime/host.hpp"
#include "components/topics.hpp"

namespace swiftlet::test {

/// Reads along in a thread of its own.
class FlightObserver {
 public:
  struct Seen {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    double speed = 0.0;
    bool on_ground = true;
    unsigned contacts = 0;
    std::string last_contact;
    unsigned mode = 0;
    std::string reason;  // on vehicle/status
    unsigned waypoint = 0;
    double longest_setpoint_gap = 0.0;  // while armed [s]
    double longest_odometry_gap = 0.0;
    double longest_motors_gap = 0.0;
  };

  explicit FlightObserver(int domain);
  ~FlightObserver();

  Seen seen() const;
  /// Gaps are counted anew.
  void forget_gaps();

 private:
  struct Reader;
  mutable std::mutex mutex_;
  Seen seen_;
  bool armed_ = false;
  Host host_;
  std::thread thread_;
};

}  // namespace swiftlet::test
