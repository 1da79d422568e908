// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/log_client.hpp"

#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

namespace swiftlet {
namespace {

constexpr Duration kTick = std::chrono::milliseconds(100);
/// Who hears nothing for so long may wonder why.
constexpr Duration kHint = std::chrono::seconds(2);

const char* name_of(screen::Severity severity) {
  switch (severity) {
    case screen::Severity::kNote:
      return "note";
    case screen::Severity::kSuccess:
      return "success";
    case screen::Severity::kCaution:
      return "caution";
    case screen::Severity::kDanger:
      return "danger";
  }
  return "note";
}

}  // namespace

std::string line_of(const screen::Event& event) {
  return screen::clock_text(event.time) + " " + screen::text_of(event);
}

std::string json_line_of(const screen::Event& event) {
  const nlohmann::ordered_json json = {{"time", to_seconds(event.time.time_since_epoch())},
                                       {"severity", name_of(event.severity)},
                                       {"text", event.text},
                                       {"times", event.times}};
  // Components write what they want into their reasons.
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

LogClient::LogClient(const ComponentContext& context, std::optional<Duration> length,
                     TellEvent tell)
    : VehicleListener(context), tell_(std::move(tell)) {
  subscribe(topic::mode_ack, [this](const swiftlet_msgs::msg::CommandAck& ack) {
    if (const auto told = commands_.hear(ack)) model_.note(now(), told->severity, told->text);
  });
  every(kTick, [this](Time now) { advance(now); });
  call_at(now() + kHint, [this](Time) {
    if (model_.vehicle().known()) return;
    log()->warn("no vehicle is heard yet; is a commander running, and is --vehicle right?");
  });
  if (!length) return;
  call_at(now() + *length, [this](Time now) {
    advance(now);
    stop(model_.vehicle().known() ? 0 : 1);
  });
}

void LogClient::advance(Time now) {
  model_.tick(now);
  const auto& events = model_.log().events();
  auto news = events.end();
  while (news != events.begin() && std::prev(news)->number > told_) --news;
  for (; news != events.end(); ++news) {
    told_ = news->number;
    if (screen::is_news(*news)) tell_(*news);
  }
}

}  // namespace swiftlet
