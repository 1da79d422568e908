// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/ground_link/link_budget.hpp"

#include <algorithm>

namespace swiftlet {
namespace {

/// Essential messages spend this much in advance at most, so that others are served again soon
/// after a burst of them [s].
constexpr double kMaxAdvance = 2.0;

}  // namespace

LinkBudget::LinkBudget(const Params& params, const std::vector<LinkTopic>& topics)
    : params_(params), tokens_(params.bytes_per_s * params.burst) {
  for (const LinkTopic& topic : topics) places_.push_back({topic});
}

void LinkBudget::offer(std::size_t topic, Cdr message, double bytes) {
  Place& place = places_.at(topic);
  ++place.counts.offered;
  const bool newest_only = place.settings.rate_hz > 0.0 || place.settings.latched;
  const std::size_t room = newest_only ? 1 : static_cast<std::size_t>(params_.queue);
  while (place.waiting.size() >= room) {
    // A queue without a rate overflows for want of budget alone.
    const bool budget = place.waiting.front().was_due || place.settings.rate_hz <= 0.0;
    ++(budget ? place.counts.over_budget : place.counts.thinned);
    place.waiting.pop_front();
  }
  place.waiting.push_back({std::move(message), bytes, false});
}

std::vector<LinkBudget::Departure> LinkBudget::depart(Time now) {
  refill(now);
  std::vector<Departure> departures;
  for (const bool essential : {true, false}) {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (places_[i].settings.essential == essential) depart(i, now, departures);
    }
  }
  return departures;
}

void LinkBudget::refill(Time now) {
  const double elapsed = started_ ? to_seconds(now - last_refill_) : 0.0;
  started_ = true;
  last_refill_ = now;
  tokens_ = std::min(params_.bytes_per_s * params_.burst, tokens_ + params_.bytes_per_s * elapsed);
}

void LinkBudget::depart(std::size_t topic, Time now, std::vector<Departure>& departures) {
  Place& place = places_[topic];
  while (!place.waiting.empty() && now >= place.next) {
    Waiting& first = place.waiting.front();
    // One message may overdraw the account, so that one larger than the burst gets through, too.
    if (!place.settings.essential && tokens_ <= 0.0) {
      first.was_due = true;
      return;
    }
    const double floor = -params_.bytes_per_s * kMaxAdvance;
    tokens_ = place.settings.essential ? std::max(tokens_ - first.bytes, std::min(tokens_, floor))
                                       : tokens_ - first.bytes;
    ++place.counts.sent;
    place.counts.sent_bytes += static_cast<std::uint64_t>(first.bytes);
    departures.push_back({topic, std::move(first.message)});
    place.waiting.pop_front();
    if (place.settings.rate_hz > 0.0) {
      // From the moment it was due, so that the rate is kept on average; a pause is not made up
      // for.
      const Duration period = from_seconds(1.0 / place.settings.rate_hz);
      place.next = std::max(place.next, now - period) + period;
    }
  }
}

}  // namespace swiftlet
