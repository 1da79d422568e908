// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/panels.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gcs/screen/drawing/widgets.hpp"

namespace swiftlet::screen {
namespace {

/// Lines of a text in one style.
void append(std::vector<Line>& lines, const std::string& text, int columns, Style style) {
  for (const std::string& line : wrap(text, columns)) lines.push_back({line, style});
}

std::string bytes_text(double bytes) {
  return bytes < 1000.0 ? fmt::format("{:.0f} B", bytes) : fmt::format("{:.1f} kB", bytes / 1e3);
}

/// When a parameter may be set, in a word.
const char* when_text(ParameterEntry::Changes changes) {
  switch (changes) {
    case ParameterEntry::Changes::kAtStart:
      return "fixed";
    case ParameterEntry::Changes::kOnGround:
      return "ground";
    case ParameterEntry::Changes::kAtAnyTime:
      return "always";
  }
  return "";
}

}  // namespace

Style style_of(Severity severity) {
  switch (severity) {
    case Severity::kNote:
      return kPlain;
    case Severity::kSuccess:
      return kGood;
    case Severity::kCaution:
      return kWarning;
    case Severity::kDanger:
      return kAlarm;
  }
  return kPlain;
}

void paint_health(const Pane& pane, const GroundStationModel& model, Time now) {
  std::vector<Line> lines;
  const auto& vehicle = model.vehicle();
  if (!vehicle.known()) {
    append(lines, "is a commander running, and is --vehicle right?", pane.width(), kDim);
  } else if (!vehicle.fresh(now)) {
    append(lines, "not known: nothing heard for " + age_text(vehicle.age(now)), pane.width(),
           kWarning);
  } else {
    const std::vector<std::string> problems = model.problems(now);
    for (const std::string& problem : problems) append(lines, problem, pane.width(), kWarning);
    if (problems.empty()) {
      lines.push_back({vehicle->armed || !vehicle->ready ? "all well" : "ready to arm", kGood});
    }
    const bool is_told = model.components().empty() && model.lives_on_telemetry(now);
    lines.push_back({is_told ? "known by telemetry alone"
                             : fmt::format("{} components", model.components().size()),
                     kDim});
    if (!vehicle->station.empty()) {
      append(lines, "control: " + (model.has_control() ? "here" : vehicle->station), pane.width(),
             model.has_control() ? kDim : kWarning);
    }
    const auto& mission = model.mission();
    if (mission.fresh(now) && mission->state == MissionReport::State::kPaused) {
      append(lines, describe_pause(*mission), pane.width(), kWarning);
    }
    const auto& link = model.link();
    if (link.fresh(now)) {
      lines.push_back({fmt::format("link {} of {}/s", bytes_text(link->bytes_per_s),
                                   bytes_text(link->budget_bytes_per_s)),
                       kDim});
    }
    if (model.guard().fresh(now) && !model.guard()->acting) {
      lines.push_back({"guard watches", kDim});
    }
  }
  draw_list(pane, lines, 0);
}

void paint_link(const Pane& pane, const GroundStationModel& model, Time now) {
  const auto& link = model.link();
  if (!link.known()) {
    pane.text(0, 0, "no ground_link, no serial_link: no budget", kDim);
    return;
  }
  const Style style = link.fresh(now) ? kPlain : kDim;
  pane.text(0, 0,
            fmt::format("{} of {}/s", bytes_text(link->bytes_per_s),
                        bytes_text(link->budget_bytes_per_s)),
            style);
  if (!link.fresh(now)) pane.text_before(pane.width(), 0, age_text(link.age(now)), kWarning);
  draw_bar(pane, 0, 1, pane.width(), link->bytes_per_s / link->budget_bytes_per_s, style);
  const auto row = [&](int y, const std::string& name, double bytes_per_s, Style name_style) {
    pane.text(0, y, name, name_style, pane.width() - 9);
    pane.text_before(pane.width(), y, bytes_text(bytes_per_s), style);
  };
  const auto count = static_cast<int>(link->topics.size());
  const int rows = pane.height() - 2;
  // The last row has all those that have none of their own.
  const int shown = count <= rows ? count : rows - 1;
  double others = 0.0;
  for (int i = 0; i < count; ++i) {
    const TopicShare& share = link->topics[static_cast<std::size_t>(i)];
    if (i < shown) {
      row(2 + i, share.topic, share.bytes_per_s, share.thinned ? kWarning : style);
    } else {
      others += share.bytes_per_s;
    }
  }
  if (shown < count) row(2 + shown, fmt::format("{} others", count - shown), others, style);
}

int paint_events(const Pane& pane, const EventLog& log, int up) {
  constexpr int kClock = 9;
  std::vector<Line> lines;
  // Only those that can be seen, from the newest on.
  for (auto event = log.events().rbegin(); event != log.events().rend(); ++event) {
    if (static_cast<int>(lines.size()) >= pane.height() + up) break;
    const std::vector<std::string> wrapped = wrap(text_of(*event), pane.width() - kClock);
    for (std::size_t i = wrapped.size(); i-- > 0;) {
      const std::string before = i == 0 ? clock_text(event->time) + " " : std::string(kClock, ' ');
      lines.push_back({before + wrapped[i], style_of(event->severity)});
    }
  }
  // Never farther than to the oldest at the top.
  const int most = std::max(0, static_cast<int>(lines.size()) - pane.height());
  lines.erase(lines.begin(), lines.begin() + std::min(up, most));
  std::reverse(lines.begin(), lines.end());
  draw_tail(pane, lines);
  return most;
}

void paint_parameters(const Pane& pane, const ParameterList& list) {
  std::vector<Line> lines;
  for (int i = 0; i < list.size(); ++i) {
    const auto index = static_cast<std::size_t>(i);
    std::string text;
    Style style;
    if (list.component.empty()) {
      text = list.components[index];
    } else {
      const ParameterEntry& entry = list.entries[index];
      text = fmt::format("{:6} {:25} {:13} {}", when_text(entry.changes), entry.name, entry.value,
                         entry.limits);
      style.dim = entry.changes == ParameterEntry::Changes::kAtStart;
    }
    style.inverse = i == list.selected;
    lines.push_back({text, style});
  }
  if (lines.empty()) {
    lines.push_back({list.component.empty() ? "nobody here has parameters" : "asking...", kDim});
  }
  draw_list(pane, lines, list.selected);
}

}  // namespace swiftlet::screen
