// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/state/event_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <utility>

namespace swiftlet::screen {
namespace {

std::string without_digits(std::string text) {
  text.erase(std::remove_if(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; }),
             text.end());
  return text;
}

}  // namespace

std::string clock_text(Time time) {
  const auto seconds = static_cast<std::time_t>(
      std::chrono::duration_cast<std::chrono::seconds>(time.time_since_epoch()).count());
  std::tm local{};
  localtime_r(&seconds, &local);
  return fmt::format("{:02}:{:02}:{:02}", local.tm_hour, local.tm_min, local.tm_sec);
}

std::string text_of(const Event& event) {
  return event.times > 1 ? fmt::format("{} ×{}", event.text, event.times) : event.text;
}

bool is_news(const Event& event) {
  if (event.times == 1) return true;
  const auto told = (event.previous - event.begun) / EventLog::kSoon;
  return (event.time - event.begun) / EventLog::kSoon > told;
}

void EventLog::add(Time time, Severity severity, const std::string& text) {
  const bool comes_and_goes = severity != Severity::kNote;
  // "settles for 0.7 s more"; but each threshold of the battery counts.
  const bool counts_down = severity == Severity::kCaution || severity == Severity::kSuccess;
  const std::size_t near = std::min(events_.size(), comes_and_goes ? kNear : 1);
  Event added{time, severity, text, 1, time, time, ++added_};
  for (auto event = events_.rbegin(); event != events_.rbegin() + static_cast<std::ptrdiff_t>(near);
       ++event) {
    if (comes_and_goes && time - event->time > kSoon) break;
    const bool same =
        counts_down ? without_digits(event->text) == without_digits(text) : event->text == text;
    if (!same || event->severity != severity) continue;
    added.times = event->times + 1;
    added.begun = event->begun;
    added.previous = event->time;
    events_.erase(std::next(event).base());
    break;
  }
  events_.push_back(std::move(added));
  if (events_.size() > kCapacity) events_.pop_front();
}

}  // namespace swiftlet::screen
