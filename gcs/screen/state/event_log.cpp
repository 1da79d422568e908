// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/state/event_log.hpp"

#include <algorithm>

namespace swiftlet::screen {
namespace {

std::string without_digits(std::string text) {
  text.erase(std::remove_if(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; }),
             text.end());
  return text;
}

}  // namespace

void EventLog::add(Time time, Severity severity, const std::string& text) {
  const bool comes_and_goes = severity != Severity::kNote;
  // "settles for 0.7 s more"; but each threshold of the battery counts.
  const bool counts_down = severity == Severity::kCaution || severity == Severity::kSuccess;
  const std::size_t near = std::min(events_.size(), comes_and_goes ? kNear : 1);
  int times = 1;
  for (auto event = events_.rbegin(); event != events_.rbegin() + static_cast<std::ptrdiff_t>(near);
       ++event) {
    if (comes_and_goes && time - event->time > kSoon) break;
    const bool same =
        counts_down ? without_digits(event->text) == without_digits(text) : event->text == text;
    if (!same || event->severity != severity) continue;
    times = event->times + 1;
    events_.erase(std::next(event).base());
    break;
  }
  events_.push_back({time, severity, text, times});
  if (events_.size() > kCapacity) events_.pop_front();
}

}  // namespace swiftlet::screen
