// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/page_sections.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "components/bag/bag_info.hpp"
#include "components/report/html_text.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using html::escaped;

const char* class_of(FlightEvent::Level level) {
  switch (level) {
    case FlightEvent::Level::kInfo:
      return "info";
    case FlightEvent::Level::kWarning:
      return "warning";
    case FlightEvent::Level::kError:
      return "error";
  }
  return "error";
}

std::string duration_text(double seconds) {
  if (seconds < 120.0) return fmt::format("{:.1f} s", seconds);
  const auto whole = std::lround(seconds);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

/// One figure; `value` is empty where it is not known, and `detail` says why.
std::string tile(const std::string& name, const std::string& value, const std::string& detail) {
  if (value.empty()) {
    return fmt::format(
        "<div><dt>{}</dt><dd class=\"unknown\">not known<small>{}</small></dd></div>",
        escaped(name), escaped(detail));
  }
  return fmt::format("<div><dt>{}</dt><dd>{}<small>{}</small></dd></div>", escaped(name),
                     escaped(value), escaped(detail));
}

std::string lacks(const char* topic) {
  return fmt::format("{} is not in the recording", topic);
}

template <class T>
std::string text_of(const std::optional<T>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "";
}

std::string tracking_tile(const char* name, const std::optional<Tracking>& tracking,
                          const std::string& missing) {
  if (!tracking) return tile(name, "", missing);
  return tile(name, fmt::format("{:.3f} m", tracking->rms.norm()),
              fmt::format("x {:.3f}, y {:.3f}, z {:.3f} m; largest {:.3f} m", tracking->rms.x(),
                          tracking->rms.y(), tracking->rms.z(), tracking->largest));
}

std::string battery_tile(const FlightStory& story) {
  const auto& battery = story.figures.battery;
  if (!battery) return tile("Battery used", "", lacks(topic::battery.name));
  const std::string energy =
      battery->energy > 0.0 ? fmt::format("{:.2f} Wh", battery->energy) : std::string();
  const std::string lowest = text_of(battery->lowest_voltage, "lowest {:.2f} V");
  const std::string joined = energy + (energy.empty() || lowest.empty() ? "" : ", ") + lowest;
  if (!battery->first_percentage) return tile("Battery used", energy, lowest);
  return tile("Battery used",
              fmt::format("{:.1f} %", *battery->first_percentage - *battery->last_percentage),
              fmt::format("from {:.1f} to {:.1f} %{}{}", *battery->first_percentage,
                          *battery->last_percentage, joined.empty() ? "" : "; ", joined));
}

std::string losses_tile(const FlightStory& story) {
  if (!story.recording.has_ledger) {
    return tile("Messages lost", "", "the recording has no ledger of losses");
  }
  std::uint64_t lost = 0;
  for (const TopicHealth& topic : story.topics) lost += topic.loss.total();
  return tile("Messages lost", lost == 0 ? "none" : std::to_string(lost),
              fmt::format("{} recorded", story.recording.messages));
}

std::string modes_flown(const FlightStory& story) {
  std::map<std::string, double> sums;
  for (const ModeSpan& span : story.modes) sums[span.mode] += span.to - span.from;
  std::string text;
  for (const auto& [mode, seconds] : sums) {
    text += (text.empty() ? "" : ", ") + mode + " " + duration_text(seconds);
  }
  return text;
}

}  // namespace

std::string header_html(const FlightStory& story) {
  const RecordingFacts& facts = story.recording;
  const std::string name =
      facts.files.size() == 1 ? std::filesystem::path(facts.name).filename().string() : facts.name;
  std::string when = fmt::format("{} long, from {} on the clock of the run",
                                 duration_text(facts.duration), moment_text(facts.begin));
  if (!facts.vehicle.empty()) when += ", vehicle " + facts.vehicle;
  std::string out = fmt::format(
      "<header><p class=\"over\">Flight report</p>\n<h1>{}</h1>\n<p class=\"when\">{}</p>\n"
      "<p class=\"outcome {}\">{}</p>\n",
      escaped(name), escaped(when), class_of(story.outcome.level), escaped(story.outcome.text));
  if (!story.modes.empty()) {
    out += fmt::format("<p class=\"when\">Modes: {}</p>\n", escaped(modes_flown(story)));
  }
  if (!facts.finished) {
    out += "<p class=\"warning\">The recording was cut off: what came last is not in it.</p>\n";
  }
  return out + "</header>\n";
}

std::string figures_html(const FlightStory& story) {
  const FlightFigures& figures = story.figures;
  const bool has_odometry = story.has(topic::odometry.name);
  const std::string no_odometry = has_odometry ? "not in flight" : lacks(topic::odometry.name);
  const std::string no_setpoint = !has_odometry ? lacks(topic::odometry.name)
                                  : story.has(topic::setpoint.name)
                                      ? "no setpoint was followed in flight"
                                      : lacks(topic::setpoint.name);
  std::string out = "<dl class=\"tiles\">\n";
  out += figures.flight_time
             ? tile("Flight time", duration_text(*figures.flight_time), "not on the ground")
             : tile("Flight time", "", lacks(topic::vehicle_status.name));
  out += tile(
      "Distance", text_of(figures.distance, "{:.1f} m"),
      figures.distance ? fmt::format("in steps of {:.0f} cm", 100.0 * Track::kStep) : no_odometry);
  out += tile("Largest speed", text_of(figures.largest_speed, "{:.2f} m/s"),
              figures.largest_speed ? "as estimated" : no_odometry);
  out += tile("Largest height", text_of(figures.largest_height, "{:.2f} m"),
              figures.largest_height ? story.modes.empty() ? "above where the recording begins"
                                                           : "above the take-off point"
                                     : no_odometry);
  out += battery_tile(story);
  out += tracking_tile("Estimate − setpoint, RMS", figures.tracking, no_setpoint);
  if (story.has(topic::sim_truth.name)) {
    out += tracking_tile("Truth − setpoint, RMS", figures.true_tracking, no_setpoint);
    out += tracking_tile("Estimate − truth, RMS", figures.estimation, no_odometry);
    out += tile("Contacts", text_of(figures.contacts, "{}"),
                figures.contacts.value_or(0) > 0 ? "last with " + figures.last_contact
                                                 : "the ground not counted");
    out += tile("Least clearance", text_of(figures.least_clearance, "{:.2f} m"),
                figures.least_clearance ? "hull to anything but the ground" : "not in flight");
  }
  out += tile("Landing", text_of(figures.landing_error, "{:.2f} m"),
              figures.landing_error ? "from the take-off point"
                                    : "take-off and landing are not both in the recording");
  out += losses_tile(story);
  out += "</dl>\n";
  if (!story.has(topic::sim_truth.name)) {
    out +=
        "<p class=\"note\">Contacts and the true position are known in simulation only "
        "(sim/truth).</p>\n";
  }
  return out +
         "<p class=\"note\">RMS over the time in flight; against the setpoint without "
         "landings, whose setpoints lie below the ground on purpose.</p>\n";
}

std::string events_html(const FlightStory& story) {
  std::string rows;
  for (const FlightEvent& event : story.events.sorted()) {
    const char* level = class_of(event.level);
    rows += fmt::format(
        "<tr data-time=\"{:.3f}\" data-kind=\"{}\"><td class=\"number\">{:.2f}</td>"
        "<td><span class=\"{}\">{}</span></td><td class=\"text\">{}</td></tr>\n",
        event.time, escaped(event.kind), event.time, level, escaped(event.kind),
        escaped(event.text));
  }
  std::string out;
  for (const char* topic :
       {topic::vehicle_status.name, topic::mode.name, topic::mode_ack.name,
        topic::guard_status.name, topic::diagnostics.name, topic::component_status.name}) {
    if (!story.has(topic)) out += (out.empty() ? "" : ", ") + std::string(topic);
  }
  if (!out.empty()) {
    out = "<p class=\"missing\">Not in the recording, or without a message: " + escaped(out) +
          "</p>\n";
  }
  if (rows.empty()) return out + "<p class=\"missing\">Nothing is known to have happened.</p>\n";
  out += "<div class=\"filters\" id=\"filters\"></div>\n" +
         html::table({"#time [s]", "what", "how"}, rows, " id=\"events\"");
  for (const auto& [kind, count] : story.events.left_out()) {
    out += fmt::format("<p class=\"note\">{} more of the kind '{}' are left out.</p>\n", count,
                       escaped(kind));
  }
  return out;
}

}  // namespace swiftlet
