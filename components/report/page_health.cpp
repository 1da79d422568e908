// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Of the page: how well sensors, estimator and recording were.
#include <fmt/format.h>

#include <algorithm>

#include "components/bag/bag_info.hpp"
#include "components/bag/recording_records.hpp"
#include "components/report/html_text.hpp"
#include "components/report/page_sections.hpp"

namespace swiftlet {
namespace {

using html::escaped;

std::string marked(const std::string& text, bool bad) {
  return bad ? "<span class=\"warning\">" + text + "</span>" : text;
}

std::string numbered(const std::string& cell) {
  return "<td class=\"number\">" + cell + "</td>";
}

std::string rate_text(double rate_hz) {
  return rate_hz > 0.0 ? fmt::format("{:.2f}", rate_hz) : "–";
}

std::string health_row(const TopicHealth& topic) {
  const std::string promised = topic.period ? fmt::format("{:.2f}", 1.0 / *topic.period) : "–";
  const std::string gap =
      topic.messages == 0
          ? "–"
          : fmt::format("{:.3f} s at {:.1f} s", topic.largest_gap, topic.largest_gap_at);
  const std::string state = topic.messages == 0  ? marked("no message", true)
                            : topic.too_slow()   ? marked("too slow", true)
                            : topic.silences > 0 ? marked("had gaps", true)
                                                 : "<span class=\"info\">well</span>";
  return "<tr><td>" + escaped(topic.topic) + "</td>" + numbered(std::to_string(topic.messages)) +
         numbered(marked(rate_text(topic.rate_hz()), topic.too_slow())) + numbered(promised) +
         numbered(marked(gap, topic.silences > 0)) +
         numbered(marked(std::to_string(topic.silences), topic.silences > 0)) + "<td>" + state +
         "</td></tr>\n";
}

std::string health_table(const FlightStory& story, bool of_sensors) {
  std::string rows;
  for (const TopicHealth& topic : story.topics) {
    if (topic.period && topic.is_sensor == of_sensors) rows += health_row(topic);
  }
  if (rows.empty()) return "";
  return html::table({of_sensors ? "sensor" : "topic", "#messages", "#rate [Hz]", "#at least [Hz]",
                      "#largest gap", "#silences", ""},
                     rows);
}

std::string files_text(const RecordingFacts& facts) {
  std::string text;
  for (const std::string& file : facts.files) text += (text.empty() ? "" : ", ") + file;
  return text;
}

std::string fact(const std::string& name, const std::string& value) {
  return "<dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd>\n";
}

}  // namespace

std::string sensors_html(const FlightStory& story) {
  std::string out;
  std::string missing;
  for (const std::string& topic : sensor_topics()) {
    const bool is_there = std::any_of(story.topics.begin(), story.topics.end(),
                                      [&](const TopicHealth& h) { return h.topic == topic; });
    if (!is_there) missing += (missing.empty() ? "" : ", ") + topic;
  }
  const std::string sensors = health_table(story, true);
  out += sensors.empty() ? "<p class=\"missing\">No topic of a sensor is in the recording.</p>\n"
                         : sensors;
  if (!missing.empty() && !sensors.empty()) {
    out += "<p class=\"missing\">Not in the recording: " + escaped(missing) + "</p>\n";
  }
  const std::string others = health_table(story, false);
  if (!others.empty()) {
    out +=
        "<details><summary>Other topics that come regularly</summary>\n" + others + "</details>\n";
  }
  return out +
         "<p class=\"note\">“At least” is what components/topics.hpp promises; a silence is longer "
         "than three of its periods, also one that lasts until the end of the recording. Times are "
         "those at which messages were recorded.</p>\n";
}

std::string estimator_html(const FlightStory& story) {
  std::string rows;
  for (const Consistency& c : story.curves.consistencies) {
    if (c.count == 0) continue;
    const double inside = 100.0 * static_cast<double>(c.inside) / static_cast<double>(c.count);
    rows += "<tr><td>" + escaped(c.name) + "</td>" + numbered(std::to_string(c.count)) +
            numbered(fmt::format("{:.2f}", c.sum / static_cast<double>(c.count))) +
            numbered(fmt::format("{:.0f} %", inside)) + "</tr>\n";
  }
  if (rows.empty()) {
    return "<p class=\"missing\">No component says on diagnostics how consistent its estimates are "
           "(NIS, NEES).</p>\n";
  }
  return html::table({"reported on diagnostics", "#reports", "#mean", "#between the bounds"},
                     rows) +
         "<p class=\"note\">Where the covariances are honest, 95 of 100 reports lie between the "
         "bounds that are drawn with them.</p>\n";
}

std::string recording_html(const FlightStory& story) {
  const RecordingFacts& facts = story.recording;
  std::string out;
  for (const std::string& remark : facts.remarks) {
    out += "<p class=\"warning\">" + escaped(remark) + "</p>\n";
  }
  out += "<dl class=\"facts\">\n" + fact("files", files_text(facts)) +
         fact("size", size_text(facts.bytes)) + fact("messages", std::to_string(facts.messages)) +
         fact("closed", facts.finished ? "yes" : "no: it was cut off");
  for (const auto& [key, value] : facts.run) {
    if (key != kRunParametersKey && !value.empty()) out += fact(key, value);
  }
  out += "</dl>\n";
  if (!facts.has_ledger) {
    out +=
        "<p class=\"missing\">The recording has no ledger of losses: whether messages were lost "
        "is not known.</p>\n";
  }
  std::string rows;
  Loss sum;
  for (const TopicHealth& topic : story.topics) {
    const auto lost = [&](std::uint64_t count) {
      return facts.has_ledger ? marked(std::to_string(count), count > 0) : std::string("–");
    };
    sum.by_dds += topic.loss.by_dds;
    sum.by_recorder += topic.loss.by_recorder;
    rows += "<tr><td>" + escaped(topic.topic) + "</td><td>" + escaped(topic.type) + "</td>" +
            numbered(std::to_string(topic.messages)) + numbered(rate_text(topic.rate_hz())) +
            numbered(lost(topic.loss.by_dds)) + numbered(lost(topic.loss.by_recorder)) + "</tr>\n";
  }
  if (facts.has_ledger) {
    out += fmt::format(
        "<p>Lost on the way to the recorder: {}. Dropped by the recorder because "
        "the disk was too slow: {}.</p>\n",
        sum.by_dds, sum.by_recorder);
  }
  out += html::table(
      {"topic", "type", "#messages", "#rate [Hz]", "#lost on the way", "#dropped by the recorder"},
      rows);
  const auto parameters = facts.run.find(kRunParametersKey);
  if (parameters != facts.run.end() && !parameters->second.empty()) {
    out += "<details><summary>Parameters of the run</summary><pre>" + escaped(parameters->second) +
           "</pre></details>\n";
  }
  return out;
}

}  // namespace swiftlet
