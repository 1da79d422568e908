// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "components/plot/figure.hpp"

namespace swiftlet::plot {
namespace {

// Around the axes of a panel, and above all panels [pixels].
constexpr int kLeft = 70, kRight = 22, kAbove = 34, kBelow = 52, kLegendBelow = 26;
constexpr int kTitleHeight = 44;
constexpr double kRoom = 0.06;     // between data and frame, as a share of the panel
constexpr double kMapRoom = 0.12;  // the same where notes stand beside points

constexpr std::array<const char*, 7> kPalette{kBlue, kRed, kGreen, kOrange, kPurple, kSky, kBlack};

/// How the panels lie in the figure [pixels].
struct Layout {
  int columns, rows, title, width, height;

  explicit Layout(const Figure& figure) {
    const auto count = static_cast<int>(figure.panels.size());
    columns = std::max(1, std::min(figure.columns, count));
    rows = (count + columns - 1) / columns;
    title = figure.title.empty() ? 0 : kTitleHeight;
    width = columns * figure.panel_width;
    height = rows * figure.panel_height + title;
  }
};

/// Text in gnuplot's single quotes, in which nothing but the quote has a meaning. That becomes the
/// one of print.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') {
      result += "’";
    } else {
      result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return result + "'";
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.9g}", value) : "NaN";
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  bool empty() const { return !(low <= high); }
  void include(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double width() const { return high - low; }
  void widen(double by) {
    low -= by;
    high += by;
  }
};

struct Ranges {
  Range x, y;
};

/// What the axes show: the data with some room, not less than a line with a width.
Ranges ranges_of(const Panel& panel) {
  Ranges all;
  for (const Series& series : panel.series) {
    for (const double x : series.x) all.x.include(x);
    for (const double y : series.y) all.y.include(y);
  }
  for (const Level& level : panel.levels) all.y.include(level.at);
  for (Range* range : {&all.x, &all.y}) {
    if (range->empty()) *range = {0.0, 1.0};
    const double scale = std::max(std::abs(range->low), std::abs(range->high));
    if (range->width() < 1e-9 * scale || range->width() == 0.0) {
      range->widen(scale > 0.0 ? 0.1 * scale : 1.0);
    }
  }
  all.y.widen((panel.equal_aspect ? kMapRoom : kRoom) * all.y.width());
  if (panel.equal_aspect) all.x.widen(kMapRoom * all.x.width());
  if (panel.x_range) all.x = {panel.x_range->first, panel.x_range->second};
  if (panel.y_range) all.y = {panel.y_range->first, panel.y_range->second};
  return all;
}

/// Widens one axis until a metre is as long on both, in a panel of a given shape.
void equalize(Ranges& ranges, double width_over_height) {
  const double missing = ranges.x.width() - width_over_height * ranges.y.width();
  if (missing < 0.0) {
    ranges.x.widen(-0.5 * missing);
  } else {
    ranges.y.widen(0.5 * missing / width_over_height);
  }
}

bool has_legend(const Panel& panel) {
  if (panel.legend == Legend::kNone) return false;
  return std::any_of(panel.series.begin(), panel.series.end(),
                     [](const Series& series) { return !series.label.empty(); }) ||
         std::any_of(panel.levels.begin(), panel.levels.end(),
                     [](const Level& level) { return !level.label.empty(); });
}

/// Where a panel's axes are in the figure [pixels], from the upper left.
struct Box {
  double left, right, top, bottom;
  double legend;  // the lower edge of a legend below

  Box(const Figure& figure, const Layout& layout, std::size_t index) {
    const auto column = static_cast<int>(index) % layout.columns;
    const auto row = static_cast<int>(index) / layout.columns;
    const Panel& panel = figure.panels[index];
    const bool below = has_legend(panel) && panel.legend == Legend::kBelow;
    left = column * figure.panel_width + kLeft;
    right = (column + 1) * figure.panel_width - kRight;
    top = layout.title + row * figure.panel_height + kAbove;
    bottom = layout.title + (row + 1) * figure.panel_height - kBelow - (below ? kLegendBelow : 0);
    legend = layout.title + (row + 1) * figure.panel_height - 10;
  }
};

std::string key_of(const Panel& panel, const Box& box, const Layout& layout) {
  if (!has_legend(panel)) return "unset key\n";
  std::string place;
  switch (panel.legend) {
    case Legend::kNone:
    case Legend::kTopRight:
      place = "inside top right vertical opaque";
      break;
    case Legend::kTopLeft:
      place = "inside top left vertical opaque";
      break;
    case Legend::kBottomRight:
      place = "inside bottom right vertical opaque";
      break;
    case Legend::kBottomLeft:
      place = "inside bottom left vertical opaque";
      break;
    case Legend::kBelow:
      place = fmt::format(
          "at screen {:.6f}, screen {:.6f} bottom center horizontal maxrows 1 noopaque",
          0.5 * (box.left + box.right) / layout.width, 1.0 - box.legend / layout.height);
      break;
  }
  return fmt::format("set key {} Left reverse samplen 2 spacing 1.05 font ',9'\n", place);
}

std::string dash_of(Dash dash) {
  switch (dash) {
    case Dash::kDashed:
      return "dashtype (9,5)";
    case Dash::kDotted:
      return "dashtype (2,4)";
    case Dash::kSolid:
    case Dash::kNoLine:
      break;
  }
  return "dashtype solid";
}

std::string marker_of(Marker marker) {
  switch (marker) {
    case Marker::kCircle:
      return "pointtype 6 pointsize 1.2";
    case Marker::kSquare:
      return "pointtype 4 pointsize 1.1";
    case Marker::kCross:
      return "pointtype 2 pointsize 1.1";
    case Marker::kDot:
    case Marker::kNone:
      break;
  }
  return "pointtype 7 pointsize 0.7";
}

std::string look_of(const Series& series, const std::string& color) {
  const Style& style = series.style;
  const bool line = style.dash != Dash::kNoLine;
  const bool points = style.marker != Marker::kNone || !line;
  std::string look = line && points ? "linespoints" : points ? "points" : "lines";
  look += fmt::format(" linecolor rgb {} linewidth {} {}", quoted(color), number(style.width),
                      dash_of(style.dash));
  if (points) look += " " + marker_of(style.marker);
  return look;
}

std::string title_of(const std::string& label) {
  return label.empty() ? "notitle" : "title " + quoted(label);
}

/// All series and levels of a panel: the data first, since gnuplot wants them ahead of the plot.
std::string curves_of(const Panel& panel, std::size_t index) {
  std::string data, plot;
  const auto add = [&](const std::string& curve) {
    plot += (plot.empty() ? "plot " : ", \\\n  ") + curve;
  };
  for (const Level& level : panel.levels) {
    add(fmt::format("{} with lines linecolor rgb {} linewidth 1.4 dashtype (9,5) {}",
                    number(level.at), quoted(level.color), title_of(level.label)));
  }
  std::size_t next_color = 0;
  for (std::size_t k = 0; k < panel.series.size(); ++k) {
    const Series& series = panel.series[k];
    const std::string name = fmt::format("$panel{}_{}", index, k);
    data += name + " << END\n";
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      data += number(series.x[i]) + " " + number(series.y[i]) + "\n";
    }
    data += "END\n";
    const std::string color =
        series.style.color.empty() ? kPalette[next_color++ % kPalette.size()] : series.style.color;
    add(fmt::format("{} using 1:2 with {} {}", name, look_of(series, color),
                    title_of(series.label)));
  }
  return data + plot + "\n";
}

std::string panel_script(const Figure& figure, const Layout& layout, std::size_t index) {
  const Panel& panel = figure.panels[index];
  const Box box(figure, layout, index);
  Ranges ranges = ranges_of(panel);
  if (panel.equal_aspect) equalize(ranges, (box.right - box.left) / (box.bottom - box.top));
  std::string script = fmt::format(
      "unset label\nunset arrow\nunset object\n"
      "set margins at screen {:.6f}, screen {:.6f}, screen {:.6f}, screen {:.6f}\n"
      "set title {} font ',11' offset 0,-0.5\nset xlabel {} offset 0,0.4\n"
      "set ylabel {} offset 0.8,0\nset xrange [{}:{}] noextend\nset yrange [{}:{}] noextend\n",
      box.left / layout.width, box.right / layout.width, 1.0 - box.bottom / layout.height,
      1.0 - box.top / layout.height, quoted(panel.title), quoted(panel.x_label),
      quoted(panel.y_label), number(ranges.x.low), number(ranges.x.high), number(ranges.y.low),
      number(ranges.y.high));
  script += key_of(panel, box, layout);
  for (const Span& span : panel.spans) {
    script += fmt::format(
        "set object rectangle from {}, graph 0 to {}, graph 1 behind fillcolor rgb {} "
        "fillstyle solid noborder\n",
        number(std::clamp(span.from, ranges.x.low, ranges.x.high)),
        number(std::clamp(span.to, ranges.x.low, ranges.x.high)), quoted(span.color));
  }
  for (const Mark& mark : panel.marks) {
    if (!(mark.at >= ranges.x.low && mark.at <= ranges.x.high)) continue;
    script += fmt::format(
        "set arrow from {0}, graph 0 to {0}, graph 1 nohead back linecolor rgb '#aaaaaa' "
        "linewidth 1 dashtype (2,4)\n",
        number(mark.at));
    if (mark.label.empty()) continue;
    script += fmt::format(
        "set label {} at {}, graph 0.06 left offset 0.4,0 font ',9' textcolor rgb '#777777'\n",
        quoted(mark.label), number(mark.at));
  }
  for (const Note& note : panel.notes) {
    if (!std::isfinite(note.x) || !std::isfinite(note.y)) continue;
    script += fmt::format("set label {} at {},{} offset 0.9,0.7 font ',10' front boxed\n",
                          quoted(note.text), number(note.x), number(note.y));
  }
  return script + curves_of(panel, index);
}

}  // namespace

std::string gnuplot_script(const Figure& figure, const std::filesystem::path& file) {
  const Layout layout(figure);
  std::string script = fmt::format(
      "set terminal pngcairo noenhanced size {},{} font 'DejaVu Sans,10' background '#ffffff'\n"
      "set output {}\nset encoding utf8\nset multiplot {}\n"
      "set border 3 linecolor rgb '#555555'\n"
      "set tics nomirror out scale 0.6 textcolor rgb '#333333'\n"
      "set grid linecolor rgb '#cccccc' linewidth 0.8 dashtype solid\nset samples 2\n"
      "set style textbox opaque noborder fillcolor rgb '#ffffff' margins 0.4,0.3\n",
      layout.width, layout.height, quoted(file.string()),
      figure.title.empty() ? "" : "title " + quoted(figure.title) + " font ',14'");
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    script += panel_script(figure, layout, i);
  }
  return script + "unset multiplot\nunset output\n";
}

}  // namespace swiftlet::plot
