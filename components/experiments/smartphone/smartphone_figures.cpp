// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/smartphone/smartphone_figures.hpp"

#include <fmt/format.h>

#include <string>

#include "components/experiments/seed_000.hpp"
#include "components/plot/figure.hpp"

namespace swiftlet {
namespace {

using seed_000::kAxes;

/// One number of each moment from `from_s` to `to_s`, over the time since `from_s`.
struct Curve {
  std::vector<double> x, y;
};

template <class Moment, class Value>
Curve curve(const std::vector<Moment>& moments, double from_s, double to_s, Value value) {
  Curve curve;
  for (const Moment& moment : moments) {
    if (moment.t < from_s || moment.t > to_s) continue;
    curve.x.push_back(moment.t - from_s);
    curve.y.push_back(value(moment));
  }
  return curve;
}

void add(plot::Panel& panel, const std::string& label, const Curve& curve,
         const plot::Style& style) {
  panel.add(label, curve.x, curve.y, style);
}

plot::Style line(const char* color, double width = 2.0) {
  plot::Style style;
  style.color = color;
  style.width = width;
  return style;
}

constexpr double kEver = 1e9;

}  // namespace

Status draw_hover(const FlightSeries& series, const PushTimes& pushes,
                  const std::filesystem::path& folder) {
  plot::Figure positions, velocities;
  positions.title = "Hover with pushes: position (Figure 7)";
  velocities.title = "Hover with pushes: velocity (Figure 8)";
  for (int axis = 0; axis < 3; ++axis) {
    plot::Panel& p = positions.panel("", "time [s]", fmt::format("{} [m]", kAxes[axis]));
    add(p, "phone",
        curve(series.phone, 0.0, kEver, [axis](const PhoneMoment& m) { return m.p_WB[axis]; }),
        line(plot::kRed, 1.0));
    add(p, "truth",
        curve(series.moments, 0.0, kEver,
              [axis](const FlightMoment& m) { return m.truth.p_WB[axis]; }),
        line(plot::kBlue));
    add(p, "UKF",
        curve(series.moments, 0.0, kEver,
              [axis](const FlightMoment& m) { return m.estimate.p_WB[axis]; }),
        line(plot::kGreen));
    if (axis == 2) p.legend = plot::Legend::kBottomRight;  // the climb leaves room there
    plot::Panel& v = velocities.panel("", "time [s]", fmt::format("v_{} [m/s]", kAxes[axis]));
    add(v, "truth",
        curve(series.moments, 0.0, kEver,
              [axis](const FlightMoment& m) { return m.truth.v_WB_W[axis]; }),
        line(plot::kBlue));
    add(v, "UKF",
        curve(series.moments, 0.0, kEver,
              [axis](const FlightMoment& m) { return m.estimate.v_WB_W[axis]; }),
        line(plot::kGreen));
    for (const auto& [from, to] : pushes) {
      p.spans.push_back({from, to});
      v.spans.push_back({from, to});
    }
  }
  if (Status status = positions.save(folder / "figure-07.png"); !status) return status;
  return velocities.save(folder / "figure-08.png");
}

Status draw_trajectory(const FlightSeries& series, double begin_s, double end_s,
                       const std::filesystem::path& folder) {
  plot::Figure above, positions, velocities;
  above.title = "The oval from above (Figure 10)";
  above.panel_width = above.panel_height = 640;
  positions.title = "The oval: position (Figure 11)";
  velocities.title = "The oval: velocity (Figure 12)";
  const auto of_flight = [&](auto value) { return curve(series.moments, begin_s, end_s, value); };
  const auto of_phone = [&](auto value) { return curve(series.phone, begin_s, end_s, value); };

  plot::Panel& plane = above.panel("", "x [m]", "y [m]");
  plane.equal_aspect = true;
  plane.add("phone", of_phone([](const PhoneMoment& m) { return m.p_WB.x(); }).y,
            of_phone([](const PhoneMoment& m) { return m.p_WB.y(); }).y, line(plot::kRed, 1.0));
  plane.add("desired", of_flight([](const FlightMoment& m) { return m.desired.position.x(); }).y,
            of_flight([](const FlightMoment& m) { return m.desired.position.y(); }).y,
            line(plot::kBlue));
  plane.add("UKF", of_flight([](const FlightMoment& m) { return m.estimate.p_WB.x(); }).y,
            of_flight([](const FlightMoment& m) { return m.estimate.p_WB.y(); }).y,
            line(plot::kGreen));
  for (int axis = 0; axis < 3; ++axis) {
    plot::Panel& p = positions.panel("", "time [s]", fmt::format("{} [m]", kAxes[axis]));
    add(p, "phone", of_phone([axis](const PhoneMoment& m) { return m.p_WB[axis]; }),
        line(plot::kRed, 1.0));
    add(p, "desired", of_flight([axis](const FlightMoment& m) { return m.desired.position[axis]; }),
        line(plot::kBlue));
    add(p, "UKF", of_flight([axis](const FlightMoment& m) { return m.estimate.p_WB[axis]; }),
        line(plot::kGreen));
    plot::Panel& v = velocities.panel("", "time [s]", fmt::format("v_{} [m/s]", kAxes[axis]));
    add(v, "desired", of_flight([axis](const FlightMoment& m) { return m.desired.velocity[axis]; }),
        line(plot::kBlue));
    add(v, "UKF", of_flight([axis](const FlightMoment& m) { return m.estimate.v_WB_W[axis]; }),
        line(plot::kGreen));
  }
  for (const auto& [figure, name] :
       {std::pair{&above, "figure-10.png"}, std::pair{&positions, "figure-11.png"},
        std::pair{&velocities, "figure-12.png"}}) {
    if (Status status = figure->save(folder / name); !status) return status;
  }
  return {};
}

}  // namespace swiftlet
