// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/plan_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace swiftlet {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Drawn larger and scaled down: finer lines and text than anti-aliasing alone gives.
constexpr int kSupersampling = 2;
constexpr int kWidestPicture = 4000;  // [pixels]
constexpr double kBorder = 0.5;       // around what is drawn [m]
constexpr int kShift = 4;             // fractional bits of OpenCV's coordinates

// Blue, green, red.
const cv::Scalar kPaper(255, 255, 255);
const cv::Scalar kFloor(250, 248, 246);
const cv::Scalar kGridLine(234, 230, 226);
const cv::Scalar kInk(60, 48, 40);
const cv::Scalar kFaintInk(150, 138, 128);
const cv::Scalar kWall(82, 66, 54);
const cv::Scalar kLow(226, 219, 211);
const cv::Scalar kLowEdge(196, 186, 176);
const cv::Scalar kObstacle(56, 56, 214);
const cv::Scalar kReference(70, 52, 40);
const cv::Scalar kPadFill(214, 236, 214);
const cv::Scalar kPadEdge(84, 142, 74);

struct Frame {
  Eigen::AlignedBox2d area;  // [m]
  int pixels_per_metre = 0;
  int left = 64;
  int top = 92;
  int bottom = 96;
  int right = 24;

  int width() const {
    return left + right + static_cast<int>(std::ceil(area.sizes().x() * pixels_per_metre));
  }
  int height() const {
    return top + bottom + static_cast<int>(std::ceil(area.sizes().y() * pixels_per_metre));
  }
  int map_bottom() const { return height() - bottom; }
};

void extend(Eigen::AlignedBox2d& box, const Vector2d& point) {
  if (point.allFinite()) box.extend(point);
}

/// The picture, in coordinates of the final image [pixels] or of the world [m].
class Canvas {
 public:
  explicit Canvas(const Frame& frame)
      : frame_(frame),
        image_(frame.height() * kSupersampling, frame.width() * kSupersampling, CV_8UC3, kPaper) {}

  Vector2d pixel(const Vector2d& p) const {
    return {frame_.left + (p.x() - frame_.area.min().x()) * frame_.pixels_per_metre,
            frame_.map_bottom() - (p.y() - frame_.area.min().y()) * frame_.pixels_per_metre};
  }

  void polygon(const std::vector<Vector2d>& world, const cv::Scalar& fill, const cv::Scalar& edge) {
    std::vector<cv::Point> points;
    for (const Vector2d& p : world) points.push_back(fixed(pixel(p)));
    cv::fillPoly(image_, std::vector<std::vector<cv::Point>>{points}, fill, cv::LINE_AA, kShift);
    cv::polylines(image_, points, true, edge, kSupersampling, cv::LINE_AA, kShift);
  }
  void line(const Vector2d& a, const Vector2d& b, const cv::Scalar& colour, double width) {
    cv::line(image_, fixed(a), fixed(b), colour,
             std::max(1, static_cast<int>(std::lround(width * kSupersampling))), cv::LINE_AA,
             kShift);
  }
  void disc(const Vector2d& centre, double radius, const cv::Scalar& fill) {
    cv::circle(image_, fixed(centre), scaled(radius), fill, cv::FILLED, cv::LINE_AA, kShift);
  }
  void rectangle(const Vector2d& a, const Vector2d& b, const cv::Scalar& fill) {
    cv::rectangle(image_, whole(a), whole(b), fill, cv::FILLED);
  }
  enum class Align { kLeft, kCentre, kRight };
  void text(const std::string& content, const Vector2d& at, double size, const cv::Scalar& colour,
            Align align = Align::kLeft, bool bold = false) {
    const double scale = scale_of(size);
    const int width = bold ? 2 * kSupersampling : static_cast<int>(1.25 * kSupersampling);
    const cv::Size extent = extent_of(content, size, width);
    cv::Point origin = whole(at);
    if (align == Align::kCentre) origin.x -= extent.width / 2;
    if (align == Align::kRight) origin.x -= extent.width;
    origin.y += extent.height / 2;
    cv::putText(image_, content, origin, cv::FONT_HERSHEY_DUPLEX, scale, colour, width,
                cv::LINE_AA);
  }
  double text_width(const std::string& content, double size) const {
    return extent_of(content, size, kSupersampling).width / static_cast<double>(kSupersampling);
  }
  cv::Mat finish() const {
    cv::Mat picture;
    cv::resize(image_, picture, cv::Size(frame_.width(), frame_.height()), 0, 0, cv::INTER_AREA);
    return picture;
  }

 private:
  static double scale_of(double size) { return size / 22.0 * kSupersampling; }  // font: 22 pixels
  static cv::Size extent_of(const std::string& content, double size, int width) {
    int baseline = 0;
    return cv::getTextSize(content, cv::FONT_HERSHEY_DUPLEX, scale_of(size), width, &baseline);
  }
  static int scaled(double pixels) {
    return static_cast<int>(std::lround(pixels * kSupersampling * (1 << kShift)));
  }
  static cv::Point fixed(const Vector2d& pixels) {
    return {scaled(pixels.x()), scaled(pixels.y())};
  }
  static cv::Point whole(const Vector2d& pixels) {
    return {static_cast<int>(std::lround(pixels.x() * kSupersampling)),
            static_cast<int>(std::lround(pixels.y() * kSupersampling))};
  }

  Frame frame_;
  cv::Mat image_;
};

/// Colour of s in [0, 1]: OpenCV's "turbo", without its dark ends.
cv::Scalar colour_of(double s) {
  cv::Mat value(1, 1, CV_8UC1, cv::Scalar(20.0 + 205.0 * std::clamp(s, 0.0, 1.0)));
  cv::Mat colour;
  cv::applyColorMap(value, colour, cv::COLORMAP_TURBO);
  const auto& c = colour.at<cv::Vec3b>(0, 0);
  return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
}

Frame frame_of(const PlanView& view) {
  Frame frame;
  for (const auto* outlines : {&view.outlines, &view.low_outlines, &view.obstacles}) {
    for (const Outline& outline : *outlines) {
      for (const Vector2d& p : outline.points) extend(frame.area, p);
    }
  }
  for (const auto* path : {&view.flown, &view.reference}) {
    for (const Vector3d& p : *path) extend(frame.area, p.head<2>());
  }
  for (const Vector2d& p : view.waypoints) extend(frame.area, p);
  if (frame.area.isEmpty()) return frame;
  if (view.pad_size > 0.0) extend(frame.area, view.pad);
  frame.area.min().array() -= kBorder;
  frame.area.max().array() += kBorder;
  const double widest = frame.area.sizes().maxCoeff();
  frame.pixels_per_metre =
      std::clamp(view.pixels_per_metre, 1, std::max(1, static_cast<int>(kWidestPicture / widest)));
  return frame;
}

void draw_grid(Canvas& canvas, const Frame& frame) {
  const auto& area = frame.area;
  canvas.rectangle(canvas.pixel({area.min().x(), area.max().y()}),
                   canvas.pixel({area.max().x(), area.min().y()}), kFloor);
  const double metre = frame.pixels_per_metre;
  const double spacing = metre >= 30.0 ? 1.0 : metre >= 6.0 ? 5.0 : 50.0;
  const auto first = [&](double from) { return std::ceil(from / spacing) * spacing; };
  for (double x = first(area.min().x()); x <= area.max().x(); x += spacing) {
    const Vector2d low = canvas.pixel({x, area.min().y()});
    canvas.line(low, canvas.pixel({x, area.max().y()}), kGridLine, 1);
    canvas.text(fmt::format("{:.0f}", x + 0.0), low + Vector2d(0, 14), 12, kFaintInk,
                Canvas::Align::kCentre);
  }
  for (double y = first(area.min().y()); y <= area.max().y(); y += spacing) {
    const Vector2d left = canvas.pixel({area.min().x(), y});
    canvas.line(left, canvas.pixel({area.max().x(), y}), kGridLine, 1);
    canvas.text(fmt::format("{:.0f}", y + 0.0), left - Vector2d(10, 0), 12, kFaintInk,
                Canvas::Align::kRight);
  }
}

void draw_outlines(Canvas& canvas, const std::vector<Outline>& outlines, const cv::Scalar& fill,
                   const cv::Scalar& edge) {
  for (const Outline& outline : outlines) {
    const bool usable = std::all_of(outline.points.begin(), outline.points.end(),
                                    [](const Vector2d& p) { return p.allFinite(); });
    if (!usable || outline.points.size() < 2) continue;
    if (outline.is_closed) {
      canvas.polygon(outline.points, fill, edge);
    } else {
      for (std::size_t i = 1; i < outline.points.size(); ++i) {
        canvas.line(canvas.pixel(outline.points[i - 1]), canvas.pixel(outline.points[i]), fill, 2);
      }
    }
  }
}

void draw_pad(Canvas& canvas, const PlanView& view) {
  if (!(view.pad_size > 0.0) || !view.pad.allFinite()) return;
  const double h = 0.5 * view.pad_size;
  std::vector<Vector2d> corners;
  for (const auto& sign : {Vector2d(-1, -1), Vector2d(1, -1), Vector2d(1, 1), Vector2d(-1, 1)}) {
    corners.push_back(view.pad + h * sign);
  }
  canvas.polygon(corners, kPadFill, kPadEdge);
  const Vector2d centre = canvas.pixel(view.pad);
  const double side = std::abs(canvas.pixel(corners[1]).x() - centre.x());
  const double arm = 0.5 * side;
  canvas.line(centre + Vector2d(-arm, -arm), centre + Vector2d(-arm, arm), kPadEdge, 3);
  canvas.line(centre + Vector2d(arm, -arm), centre + Vector2d(arm, arm), kPadEdge, 3);
  canvas.line(centre + Vector2d(-arm, 0), centre + Vector2d(arm, 0), kPadEdge, 3);
}

/// Largest finite speed, rounded up to a tenth; zero where no speeds are given.
double top_speed(const PlanView& view) {
  double top = 0.0;
  for (const double speed : view.flown_speed) {
    if (std::isfinite(speed)) top = std::max(top, speed);
  }
  return std::ceil(10.0 * top) / 10.0;
}

void draw_path(Canvas& canvas, const std::vector<Vector3d>& path, const cv::Scalar& colour,
               double width) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (!path[i - 1].allFinite() || !path[i].allFinite()) continue;
    canvas.line(canvas.pixel(path[i - 1].head<2>()), canvas.pixel(path[i].head<2>()), colour,
                width);
  }
}

void draw_flown(Canvas& canvas, const PlanView& view) {
  const double top = top_speed(view);
  draw_path(canvas, view.flown, kPaper, 7);  // a halo that lifts the path off the grid
  if (top <= 0.0) return draw_path(canvas, view.flown, colour_of(0.1), 3.5);
  for (std::size_t i = 1; i < view.flown.size(); ++i) {
    const double speed = i < view.flown_speed.size() ? view.flown_speed[i] : 0.0;
    draw_path(canvas, {view.flown[i - 1], view.flown[i]},
              colour_of(std::isfinite(speed) ? speed / top : 0.0), 3.5);
  }
}

void draw_marks(Canvas& canvas, const PlanView& view) {
  for (std::size_t i = 0; i < view.waypoints.size(); ++i) {
    if (!view.waypoints[i].allFinite()) continue;
    const Vector2d at = canvas.pixel(view.waypoints[i]);
    canvas.disc(at, 15, kInk);
    canvas.disc(at, 13, kPaper);
    canvas.text(fmt::format("{}", i + 1), at, 16, kInk, Canvas::Align::kCentre, true);
  }
  for (const Vector2d& place : view.collisions) {
    if (!place.allFinite()) continue;
    const Vector2d at = canvas.pixel(place);
    canvas.line(at + Vector2d(-8, -8), at + Vector2d(8, 8), kObstacle, 3);
    canvas.line(at + Vector2d(-8, 8), at + Vector2d(8, -8), kObstacle, 3);
  }
}

/// The line of symbols below the map, in as many rows as its width needs.
class Legend {
 public:
  Legend(Canvas& canvas, const Frame& frame)
      : canvas_(canvas),
        left_(frame.left),
        end_(frame.width() - frame.right),
        at_(frame.left, frame.map_bottom() + 46) {}

  /// `symbol` draws about the point that it is given, the middle of its left side.
  template <class Symbol>
  void add(const std::string& name, double symbol_width, Symbol symbol) {
    constexpr double kGap = 10.0;
    constexpr double kSpacing = 26.0;
    const double width = symbol_width + kGap + canvas_.text_width(name, kTextSize);
    if (at_.x() + width > end_ && at_.x() > left_) at_ = {left_, at_.y() + kRow};
    symbol(at_);
    canvas_.text(name, at_ + Vector2d(symbol_width + kGap, 0), kTextSize, kInk);
    at_.x() += width + kSpacing;
  }
  void add_swatch(const std::string& name, const cv::Scalar& fill, const cv::Scalar& edge) {
    add(name, 20, [&](const Vector2d& at) {
      canvas_.rectangle(at + Vector2d(0, -8), at + Vector2d(20, 8), edge);
      canvas_.rectangle(at + Vector2d(1.5, -6.5), at + Vector2d(18.5, 6.5), fill);
    });
  }

 private:
  static constexpr double kTextSize = 14.0;
  static constexpr double kRow = 26.0;
  Canvas& canvas_;
  double left_;
  double end_;
  Vector2d at_;
};

/// Title above the map; scale and the meaning of the colours below it.
void draw_legend(Canvas& canvas, const PlanView& view, const Frame& frame) {
  canvas.text(view.title, Vector2d(frame.left, 34), 24, kInk, Canvas::Align::kLeft, true);
  canvas.text(view.subtitle, Vector2d(frame.left, 66), 14, kFaintInk);

  Legend legend(canvas, frame);
  const double metre = frame.pixels_per_metre;
  legend.add("1 m", metre, [&](const Vector2d& at) {
    canvas.line(at, at + Vector2d(metre, 0), kInk, 2);
    for (const double end : {0.0, metre}) {
      canvas.line(at + Vector2d(end, -5), at + Vector2d(end, 5), kInk, 2);
    }
  });
  if (!view.flown.empty()) {
    const double top = top_speed(view);
    constexpr int kBar = 100;
    legend.add(top > 0.0 ? fmt::format("flown, 0 to {:.1f} m/s", top) : "flown", kBar,
               [&](const Vector2d& at) {
                 for (int i = 0; i < kBar; ++i) {
                   canvas.rectangle(at + Vector2d(i, -5), at + Vector2d(i + 1, 5),
                                    colour_of(top > 0.0 ? static_cast<double>(i) / kBar : 0.1));
                 }
               });
  }
  if (!view.reference.empty()) {
    legend.add("reference", 36,
               [&](const Vector2d& at) { canvas.line(at, at + Vector2d(36, 0), kReference, 0.8); });
  }
  legend.add_swatch("wall", kWall, kWall);
  if (!view.low_outlines.empty()) legend.add_swatch("below the flight", kLow, kLowEdge);
  if (!view.obstacles.empty()) legend.add_swatch("obstacle", kObstacle, kObstacle);
  if (!view.collisions.empty()) {
    legend.add("contact", 14, [&](const Vector2d& at) {
      canvas.line(at + Vector2d(0, -7), at + Vector2d(14, 7), kObstacle, 3);
      canvas.line(at + Vector2d(0, 7), at + Vector2d(14, -7), kObstacle, 3);
    });
  }
}

}  // namespace

Status draw_plan_view(const PlanView& view, const std::filesystem::path& file) {
  const Frame frame = frame_of(view);
  if (frame.area.isEmpty()) return Error{"the plan view has nothing to draw"};
  if (frame.area.sizes().maxCoeff() > kWidestPicture) {
    return Error{fmt::format("the plan view is {:.0f} m wide, more than {} m",
                             frame.area.sizes().maxCoeff(), kWidestPicture)};
  }
  Canvas canvas(frame);
  draw_grid(canvas, frame);
  draw_outlines(canvas, view.low_outlines, kLow, kLowEdge);
  draw_pad(canvas, view);
  draw_outlines(canvas, view.outlines, kWall, kWall);
  draw_outlines(canvas, view.obstacles, kObstacle, kObstacle);
  draw_flown(canvas, view);
  draw_path(canvas, view.reference, kReference, 0.8);
  draw_marks(canvas, view);
  draw_legend(canvas, view, frame);
  try {
    if (cv::imwrite(file.string(), canvas.finish())) return {};
  } catch (const cv::Exception&) {
    // No writer for this extension; reported below like every other failure to write.
  }
  return Error{
      fmt::format("{}: picture cannot be written; check folder and extension", file.string())};
}

}  // namespace swiftlet
