// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "estimation/basics/result.hpp"
#include "estimation/basics/time.hpp"
#include "estimation/geometry/rigid_body.hpp"

namespace swiftlet {

/// The motion of a body as it was measured from outside, and that between its samples.
class MotionLog {
 public:
  /// Reads, by the number of columns,
  ///   8: seconds, position, quaternion x y z w, as the TUM benchmark has them;
  ///   11 and more: nanoseconds, position, quaternion w x y z, velocity, as EuRoC has them.
  /// Quaternions are normalised; where there is no velocity it is that of the positions a tenth of
  /// a second apart. Times must rise.
  static Result<MotionLog> read(const std::filesystem::path& file);

  Time begin() const { return samples_.front().time; }
  Time end() const { return samples_.back().time; }
  /// Position and velocity of the cubic through both neighbours, spherical linear attitude and the
  /// angular velocity of that. Nothing before the first, after the last, and in a gap of more than
  /// a quarter of a second.
  std::optional<RigidBodyState> at(Time time) const;

 private:
  struct Sample {
    Time time;
    RigidBodyState state;
  };
  void differentiate();

  std::vector<Sample> samples_;
};

}  // namespace swiftlet
