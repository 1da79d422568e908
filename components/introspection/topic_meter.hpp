// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/introspection/sliding_window.hpp"
#include "components/introspection/topic_observer.hpp"

namespace swiftlet {

struct MeterParams {
  std::string topic;
  int window = 10000;  ///< samples that a report is about, at most
  int count = 0;       ///< reports, 0: until the run ends
  bool json = false;   ///< a line a report
};

/// Measures a topic and prints a report: the first half a second after the first sample, then one
/// a second.
class TopicMeter : public TopicObserver {
 public:
  TopicMeter(const ComponentContext& context, const MeterParams& params);

 protected:
  void add(Time time, double value);
  const SlidingWindow& window() const { return window_; }
  const MeterParams& params() const { return params_; }
  /// A report, with a line break at its end; nothing where too little is known.
  virtual std::optional<std::string> report(Time now) const = 0;

 private:
  bool open(const TopicView& topic, const std::string& type) final;
  void print(Time now);

  MeterParams params_;
  SlidingWindow window_;
  Time next_{};
  std::size_t added_ = 0;
  std::size_t reported_ = 0;
  int reports_ = 0;
};

/// How often a topic's samples come, as `ros2 topic hz` says it.
class RateMeter : public TopicMeter {
 public:
  using TopicMeter::TopicMeter;

 private:
  void sample(const Cdr& cdr, Time now) override;
  std::optional<std::string> report(Time now) const override;

  std::optional<Time> last_;
};

/// How many bytes a second a topic takes, as `ros2 topic bw` says it.
class BandwidthMeter : public TopicMeter {
 public:
  using TopicMeter::TopicMeter;

 private:
  void sample(const Cdr& cdr, Time now) override;
  std::optional<std::string> report(Time now) const override;
};

/// "1.25 MB": of 1000, as network speeds are.
std::string bytes_text(double bytes);

}  // namespace swiftlet
