// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/report_page.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "components/report/html_text.hpp"
#include "components/report/map_picture.hpp"
#include "components/report/page_assets.hpp"
#include "components/report/page_data.hpp"
#include "components/report/page_sections.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using html::escaped;

/// What a section of plots needs, to say what is missing.
struct PlotSection {
  const char* title;
  const char* needs;
};
constexpr PlotSection kPlotSections[] = {
    {"Position", "odometry, setpoint"},
    {"Error", "odometry with setpoint, or with sim/truth"},
    {"Speed", "odometry"},
    {"Attitude", "odometry"},
    {"Battery", "battery"},
    {"Estimator", "diagnostics"},
};

/// A hash as content security policies have it.
std::string source_of(const PageAsset& asset) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < asset.sha256.size(); i += 2) {
    bytes.push_back(
        static_cast<std::uint8_t>(std::strtoul(asset.sha256.substr(i, 2).c_str(), nullptr, 16)));
  }
  return "'sha256-" + html::base64(bytes) + "'";
}

std::string head(const FlightStory& story) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src {}; script-src {}; base-uri 'none'; form-action 'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Flight report: {}</title>\n<style>{}</style>\n</head>\n<body>\n",
      source_of(page_style()), source_of(page_script()), escaped(story.recording.name),
      page_style().text);
}

std::string section(const std::string& id, const std::string& title, const std::string& content) {
  return fmt::format("<section id=\"{}\"><h2>{}</h2>\n{}</section>\n", id, title, content);
}

std::string plots_html(const PlotSection& about, const std::vector<TimePlot>& plots) {
  std::string out;
  for (std::size_t i = 0; i < plots.size(); ++i) {
    if (plots[i].section != about.title) continue;
    out += fmt::format("<figure data-plot=\"{}\"></figure>\n", i);
  }
  if (out.empty()) {
    out = fmt::format("<p class=\"missing\">The recording has nothing for this: it needs {}.</p>\n",
                      about.needs);
  }
  return out;
}

std::string map_html(const FlightStory& story, const std::optional<MapPicture>& picture,
                     const std::string& problem) {
  std::string out;
  if (has_map(story)) out += "<figure class=\"map\" id=\"map\"></figure>\n";
  if (!problem.empty()) out += "<p class=\"warning\">" + escaped(problem) + "</p>\n";
  if (!story.has(topic::map.name)) {
    out +=
        "<p class=\"missing\">map is not in the recording: only ways and places are "
        "drawn.</p>\n";
  }
  if (story.map.flown.points().empty()) {
    out +=
        "<p class=\"missing\">No flown track: odometry is not in the recording, or the vehicle "
        "did not fly.</p>\n";
  }
  if (story.map.global_waypoints > 0) {
    out += fmt::format(
        "<p class=\"note\">{} waypoints are places on Earth and are not drawn; the "
        "goals that they became in the map are.</p>\n",
        story.map.global_waypoints);
  }
  if (!picture) return out;
  out += fmt::format(
      "<p class=\"note\">The last map of the recording, of {:.1f} s; the grid is in "
      "metres, north is up.",
      story.map.grid_time);
  if (picture->cells_per_pixel > 1) {
    out += fmt::format(" {0} × {0} cells are one pixel, which shows the most occupied of them.",
                       picture->cells_per_pixel);
  }
  return out + "</p>\n";
}

constexpr const char* kNavigation =
    "<nav><a href=\"#map-section\">Map</a><a href=\"#position\">Position</a>"
    "<a href=\"#error\">Error</a><a href=\"#speed\">Speed</a><a href=\"#attitude\">Attitude</a>"
    "<a href=\"#battery\">Battery</a><a href=\"#event-section\">Events</a>"
    "<a href=\"#sensors\">Sensors</a><a href=\"#estimator\">Estimator</a>"
    "<a href=\"#recording\">Recording</a></nav>\n";

std::string id_of(std::string title) {
  for (char& c : title) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return title;
}

/// JSON that a page may contain: no '<' that could end its element.
std::string embedded(const nlohmann::json& data) {
  std::string text = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) c == '<' ? out += "\\u003c" : out += c;
  return out;
}

}  // namespace

std::string report_page(const FlightStory& story) {
  const std::vector<TimePlot> plots = plots_of(story);
  std::optional<MapPicture> picture;
  std::string map_problem;
  if (story.map.grid) {
    auto drawn = draw_map(*story.map.grid);
    if (drawn.ok()) {
      picture = std::move(drawn).value();
    } else {
      map_problem = drawn.error().reason;
    }
  }
  std::string page = head(story) + header_html(story) + figures_html(story) + kNavigation;
  page += "<div class=\"ribbon\" id=\"ribbon\"><div class=\"now\"></div></div>\n";
  if (story.modes.empty()) {
    page +=
        "<p class=\"missing\">vehicle/status is not in the recording: the modes are not "
        "known.</p>\n";
  }
  page +=
      "<noscript><p class=\"warning\">Plots and map are drawn by a script, which this browser "
      "does not run. Figures and tables are complete.</p></noscript>\n";
  page += section("map-section", "Map", map_html(story, picture, map_problem));
  for (const PlotSection& about : kPlotSections) {
    const bool is_estimator = std::string(about.title) == "Estimator";
    if (is_estimator) {
      page += section("event-section", "Events", events_html(story));
      page += section("sensors", "Sensor health", sensors_html(story));
      page += section("estimator", "Consistency of the estimator",
                      estimator_html(story) +
                          (story.curves.consistencies.empty() ? "" : plots_html(about, plots)));
    } else {
      page += section(id_of(about.title), about.title, plots_html(about, plots));
    }
  }
  page += section("recording", "Recording and loss ledger", recording_html(story));
  page += fmt::format(
      "<footer><p>Times are seconds since the beginning of the recording. Figures are of all "
      "samples. Curves are thinned for the eye: the time is cut into {} columns, and of each the "
      "smallest and the largest sample are drawn as they are, so no peak is lost. A line is broken "
      "where nothing came.</p></footer>\n",
      ThinnedCurve::kColumns);
  page += "<script type=\"application/json\" id=\"data\">" +
          embedded(page_data(story, plots, picture)) + "</script>\n<script>" + page_script().text +
          "</script>\n</body>\n</html>\n";
  return page;
}

Status write_report(const FlightStory& story, const std::filesystem::path& file) {
  const std::string page = report_page(story);
  std::filesystem::path beside = file;
  beside += ".partial";
  std::error_code error;
  {
    std::ofstream stream(beside, std::ios::binary);
    stream.write(page.data(), static_cast<std::streamsize>(page.size()));
    stream.close();
    if (!stream) {
      std::filesystem::remove(beside, error);
      return Error{
          fmt::format("{}: cannot be written; does the folder exist, is it writable, is "
                      "there space left?",
                      file.string())};
    }
  }
  std::filesystem::rename(beside, file, error);
  if (error) {
    const std::string why = error.message();
    std::filesystem::remove(beside, error);
    return Error{fmt::format("{}: cannot be written: {}", file.string(), why)};
  }
  return {};
}

}  // namespace swiftlet
