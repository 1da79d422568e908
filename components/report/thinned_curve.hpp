// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace swiftlet {

/// A point of a curve.
struct CurvePoint {
  double time = 0.0;  ///< since the beginning of the recording [s]
  double value = 0.0;
  bool begins = false;  ///< no line leads to it from the point before
};

/// A curve for the eye, thinned while it is read, so that it takes the same memory for a minute as
/// for a day: its time is cut into columns, about as narrow as a pixel, and of the samples in a
/// column the smallest and the largest stay, as they were and in their order. No peak is lost.
class ThinnedCurve {
 public:
  static constexpr int kColumns = 2000;

  /// `duration` of the recording [s]. The line is broken where nothing came for more than
  /// `longest_gap` [s].
  ThinnedCurve(double duration, double longest_gap, int columns = kColumns);

  /// Samples come in the order of time, about. One that is not finite breaks the line.
  void add(double time, double value);
  /// The line ends here; the next sample begins another.
  void lift();

  bool empty() const { return samples_ == 0; }
  std::uint64_t samples() const { return samples_; }
  std::vector<CurvePoint> points() const;

 private:
  struct Column {
    CurvePoint smallest, largest;
    bool begins = false;
  };
  static void write(const Column& column, std::vector<CurvePoint>& points);

  double column_width_;
  double longest_gap_;
  std::uint64_t samples_ = 0;
  bool lifted_ = true;
  double last_time_ = 0.0;
  double column_end_ = 0.0;
  std::optional<Column> open_;
  std::vector<CurvePoint> points_;
};

/// Turns an angle that is known from -180 to 180 degrees into one that jumps less: it goes on up to
/// 190 degrees before it comes back on the other side, so that a heading of about 180 degrees is
/// one line and not a saw.
class AngleLine {
 public:
  struct Angle {
    double value = 0.0;   ///< [deg]
    bool jumped = false;  ///< came back on the other side
  };
  Angle next(double degrees);

 private:
  std::optional<double> last_;
};

}  // namespace swiftlet
