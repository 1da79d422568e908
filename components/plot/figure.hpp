// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "estimation/basics/result.hpp"

/// Figures as papers have them, drawn by gnuplot into PNG files:
///
///     plot::Figure figure;
///     figure.title = "Hovering";
///     plot::Panel& panel = figure.panel("Position", "time [s]", "x [m]");
///     panel.add("desired", t, x_desired, {plot::kBlue});
///     panel.add("estimated", t, x, {plot::kRed, plot::Dash::kDashed});
///     panel.levels.push_back({0.5, "limit"});
///     Status drawn = figure.save("hovering.png");
namespace swiftlet::plot {

// Colours that stay apart, also for the colour-blind (Okabe and Ito 2008).
inline constexpr const char* kBlue = "#0072b2";
inline constexpr const char* kRed = "#d55e00";
inline constexpr const char* kGreen = "#009e73";
inline constexpr const char* kOrange = "#e69f00";
inline constexpr const char* kSky = "#56b4e9";
inline constexpr const char* kPurple = "#cc79a7";
inline constexpr const char* kBlack = "#222222";
inline constexpr const char* kGrey = "#888888";
inline constexpr const char* kPale = "#e8eef4";

enum class Dash { kSolid, kDashed, kDotted, kNoLine };
enum class Marker { kNone, kDot, kCircle, kSquare, kCross };
enum class Legend { kNone, kTopRight, kTopLeft, kBottomRight, kBottomLeft, kBelow };

/// How a series looks.
struct Style {
  std::string color = {};  ///< "#rrggbb"; empty for the next colour of the panel
  Dash dash = Dash::kSolid;
  Marker marker = Marker::kNone;
  double width = 2.0;  ///< of the line, in pixels about
};

/// Points (x, y) in their order. What is not finite is a gap.
struct Series {
  std::string label;  ///< in the legend; empty for none
  std::vector<double> x, y;
  Style style;
};

/// A shaded part of the x axis.
struct Span {
  double from = 0.0, to = 0.0;
  std::string color = kPale;
};

/// A vertical line at a place on the x axis, with a word at its lower end.
struct Mark {
  double at = 0.0;
  std::string label = {};
};

/// A horizontal line across the panel, such as a limit.
struct Level {
  double at = 0.0;
  std::string label = {};  ///< in the legend
  std::string color = kGrey;
};

/// A word beside a point.
struct Note {
  double x = 0.0, y = 0.0;
  std::string text;
};

/// One pair of axes.
struct Panel {
  std::string title, x_label, y_label;
  bool equal_aspect = false;  ///< a metre is as long on both axes, as on a map
  Legend legend = Legend::kTopRight;
  std::optional<std::pair<double, double>> x_range = {}, y_range = {};  ///< else as the data need
  std::vector<Series> series = {};
  std::vector<Span> spans = {};
  std::vector<Mark> marks = {};
  std::vector<Level> levels = {};
  std::vector<Note> notes = {};

  /// Adds a series. `x` and `y` have the same number of values.
  void add(const std::string& label, std::vector<double> x, std::vector<double> y,
           const Style& style = {}) {
    series.push_back({label, std::move(x), std::move(y), style});
  }
};

/// Panels in rows from the left, under one title.
struct Figure {
  std::string title = {};
  int columns = 1;
  int panel_width = 560, panel_height = 320;  ///< [pixels]
  std::vector<Panel> panels = {};

  /// Adds an empty panel; the reference holds until the next is added.
  Panel& panel(const std::string& panel_title, const std::string& x_label,
               const std::string& y_label) {
    panels.push_back({panel_title, x_label, y_label});
    return panels.back();
  }

  /// Draws into a PNG file. Fails where gnuplot is not there, where there is nothing to draw, where
  /// x and y of a series differ in number, and where the file cannot be written.
  Status save(const std::filesystem::path& file) const;
};

/// The program that draws the figure, in gnuplot's language: what save() runs.
std::string gnuplot_script(const Figure& figure, const std::filesystem::path& file);

}  // namespace swiftlet::plot
