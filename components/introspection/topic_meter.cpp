// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/topic_meter.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kTick = 20ms;
constexpr Duration kFirstReport = 500ms;
constexpr Duration kPeriod = 1s;

}  // namespace

TopicMeter::TopicMeter(const ComponentContext& context, const MeterParams& params)
    : TopicObserver(context, params.topic),
      params_(params),
      window_(static_cast<std::size_t>(params.window)) {
  every(kTick, [this](Time now) { print(now); });
}

void TopicMeter::add(Time time, double value) {
  window_.add(time, value);
  ++added_;
}

bool TopicMeter::open(const TopicView&, const std::string&) {
  return true;
}

void TopicMeter::print(Time now) {
  if (added_ == 0) return;
  if (next_ == Time{}) next_ = now + kFirstReport;
  if (now < next_ || (params_.count > 0 && reports_ == params_.count)) return;
  const auto text = report(now);
  if (!text) return;
  next_ = now + kPeriod;
  if (added_ == reported_) {
    log()->warn("nothing new on '{}'", params_.topic);
    return;
  }
  reported_ = added_;
  fmt::print("{}", *text);
  std::fflush(stdout);
  if (++reports_ == params_.count) stop(0);
}

void RateMeter::sample(const Cdr&, Time now) {
  if (last_) add(now, to_seconds(now - *last_));
  last_ = now;
}

std::optional<std::string> RateMeter::report(Time) const {
  const Spread spread = window().spread();
  if (spread.mean <= 0.0) return std::nullopt;
  if (params().json) {
    const nlohmann::ordered_json json{
        {"topic", params().topic}, {"rate_hz", 1.0 / spread.mean},  {"min_s", spread.min},
        {"max_s", spread.max},     {"std_dev_s", spread.deviation}, {"window", spread.count}};
    return json.dump() + "\n";
  }
  return fmt::format(
      "average rate: {:.3f}\n\tmin: {:.3f}s max: {:.3f}s std dev: {:.5f}s window: {}\n",
      1.0 / spread.mean, spread.min, spread.max, spread.deviation, spread.count);
}

void BandwidthMeter::sample(const Cdr& cdr, Time now) {
  add(now, static_cast<double>(cdr.size()));
}

std::optional<std::string> BandwidthMeter::report(Time now) const {
  const Spread spread = window().spread();
  const double seconds = to_seconds(window().age(now));
  if (seconds <= 0.0 || spread.count < 2) return std::nullopt;
  // What came since the oldest sample; that one was sent before.
  const double rate =
      (spread.mean * static_cast<double>(spread.count) - window().oldest()) / seconds;
  if (params().json) {
    const nlohmann::ordered_json json{{"topic", params().topic},   {"bytes_per_s", rate},
                                      {"mean_bytes", spread.mean}, {"min_bytes", spread.min},
                                      {"max_bytes", spread.max},   {"window", spread.count}};
    return json.dump() + "\n";
  }
  return fmt::format("{}/s from {} messages\n\tMessage size mean: {} min: {} max: {}\n",
                     bytes_text(rate), spread.count, bytes_text(spread.mean),
                     bytes_text(spread.min), bytes_text(spread.max));
}

std::string bytes_text(double bytes) {
  if (bytes < 1e3) return fmt::format("{:.0f} B", bytes);
  if (bytes < 1e6) return fmt::format("{:.2f} KB", bytes / 1e3);
  if (bytes < 1e9) return fmt::format("{:.2f} MB", bytes / 1e6);
  return fmt::format("{:.2f} GB", bytes / 1e9);
}

}  // namespace swiftlet
