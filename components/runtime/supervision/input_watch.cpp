// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/supervision/input_watch.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace swiftlet {
namespace {

constexpr int kSilentPeriods = 3;
/// Shorter silences are not reported: a busy machine has them now and then.
constexpr Duration kShortestSilence = std::chrono::milliseconds(100);
/// A topic that comes less often than this share of its rate is too slow to work with.
constexpr double kSlow = 0.5;

}  // namespace

bool InputWatch::accept(const EndpointGuid& writer, Time now) {
  if (periodic()) {
    const bool source_lives = heard_ && now - *heard_ <= kSilentPeriods * period_;
    if (writer != source_) {
      if (source_lives) return false;
      source_ = writer;
      samples_ = 0;  // its rate is that of the time since it speaks
    }
  }
  heard_ = now;
  ++messages_;
  return true;
}

void InputWatch::sample_rate(Time now) {
  if (!heard_) return;
  std::rotate(counts_.begin(), counts_.begin() + 1, counts_.end());
  counts_.back() = {now, messages_};
  ++samples_;
}

std::optional<double> InputWatch::rate_hz() const {
  if (samples_ < kCounts) return std::nullopt;
  const double time = to_seconds(counts_.back().time - counts_.front().time);
  if (time < kSilentPeriods * to_seconds(period_)) return std::nullopt;
  return static_cast<double>(counts_.back().messages - counts_.front().messages) / time;
}

InputWatch::Problem InputWatch::problem(Time now, int matched_writers) const {
  if (!periodic()) return {};
  if (matched_writers == 0) return {fmt::format("{}: nobody writes it", topic_), true};
  if (!heard_) return {fmt::format("{}: its writer has sent nothing yet", topic_), true};
  if (now - *heard_ > std::max(kSilentPeriods * period_, kShortestSilence)) {
    return {fmt::format("{}: silent for {:.2f} s", topic_, to_seconds(now - *heard_)), true};
  }
  const std::optional<double> rate = rate_hz();
  const double wanted = 1.0 / to_seconds(period_);
  if (rate && *rate < kSlow * wanted) {
    return {fmt::format("{}: {:.0f} Hz, {:.0f} Hz are usual", topic_, *rate, wanted), false};
  }
  return {};
}

}  // namespace swiftlet
