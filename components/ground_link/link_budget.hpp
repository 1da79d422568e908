// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "components/runtime/message.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

/// How one topic may use the link.
struct LinkTopic {
  double rate_hz = 0.0;    ///< of it at most; 0: every message
  bool essential = false;  ///< sent even where the budget is used up
  bool latched = false;    ///< only the newest counts, and it must arrive in the end
};

/// What became of the messages of one topic.
struct LinkCounts {
  std::uint64_t offered = 0;
  std::uint64_t sent = 0;
  std::uint64_t sent_bytes = 0;
  std::uint64_t thinned = 0;      ///< left out because of the topic's rate
  std::uint64_t over_budget = 0;  ///< left out because the budget was used up
};

/// Decides which messages cross a narrow link: a token bucket filled by the budget. The topics are
/// in the order of their priority; what stands first is served first. Essential ones always go, and
/// are paid for before all others. Of a topic with a rate, the newest message is sent; of one
/// without, each is, up to a queue that drops its oldest.
class LinkBudget {
 public:
  struct Params {
    double bytes_per_s = 20'000.0;
    double burst = 0.25;  ///< so many seconds' worth may be sent at once [s]
    int queue = 32;       ///< messages that wait, of a topic without a rate
  };
  struct Departure {
    std::size_t topic;
    Cdr message;
  };

  LinkBudget(const Params& params, const std::vector<LinkTopic>& topics);

  void set_latched(std::size_t topic) { places_.at(topic).settings.latched = true; }
  /// A message that would like to cross. It costs `bytes` on the wire.
  void offer(std::size_t topic, Cdr message, double bytes);
  /// The messages that cross now, in order.
  std::vector<Departure> depart(Time now);
  const LinkCounts& counts(std::size_t topic) const { return places_.at(topic).counts; }

 private:
  struct Waiting {
    Cdr message;
    double bytes;
    bool was_due;  // and found the budget used up
  };
  struct Place {
    LinkTopic settings;
    LinkCounts counts{};
    std::deque<Waiting> waiting{};
    Time next{};  // of a topic with a rate: not before
  };

  void refill(Time now);
  void depart(std::size_t topic, Time now, std::vector<Departure>& departures);

  Params params_;
  std::vector<Place> places_;
  double tokens_;  // [byte]; below 0: spent in advance
  Time last_refill_{};
  bool started_ = false;
};

}  // namespace swiftlet
