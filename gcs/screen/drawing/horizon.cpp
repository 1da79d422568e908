// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/drawing/horizon.hpp"

#include <cmath>

#include "gcs/screen/drawing/braille.hpp"

namespace swiftlet::screen {
namespace {

constexpr int kGround = 0;
constexpr int kLine = 1;

/// One dot in every second cell, so that the line stands out.
bool hatched(int x, int y) {
  return y % Braille::kDown == 0 && (x + y / 2) % (2 * Braille::kAcross) == 0;
}

void draw_mark(const Pane& pane) {
  const int x = pane.width() / 2;
  const int y = pane.height() / 2;
  constexpr Style mark{Hue::kYellow, true, false, false};
  for (const int side : {-1, 1}) {
    for (int i = 3; i <= 5; ++i) pane.put(x + side * i, y, U'━', mark);
  }
  pane.put(x, y, U'╋', mark);
}

}  // namespace

void draw_horizon(const Pane& pane, const Eigen::Quaterniond& q_WB, Style line) {
  Braille dots(pane.width(), pane.height());
  // The world's vertical in the body: a direction d looks above the horizon where d . up > 0.
  const Eigen::Vector3d up = q_WB.conjugate() * Eigen::Vector3d::UnitZ();
  const double per_dot = std::tan(kHorizonView) / (0.5 * dots.height());
  const auto height_of = [&](int x, int y) {
    const double right = per_dot * (x + 0.5 - 0.5 * dots.width());
    const double above = per_dot * (0.5 * dots.height() - y - 0.5);
    return up.x() - right * up.y() + above * up.z();
  };
  if (up.allFinite() && std::abs(up.norm() - 1.0) < 0.1) {
    for (int y = 0; y < dots.height(); ++y) {
      for (int x = 0; x < dots.width(); ++x) {
        const bool ground = height_of(x, y) < 0.0;
        const bool edge =
            ground != (height_of(x, y - 1) < 0.0) || ground != (height_of(x - 1, y) < 0.0);
        if (edge) {
          dots.dot(x, y, kLine);
        } else if (ground && hatched(x, y)) {
          dots.dot(x, y, kGround);
        }
      }
    }
  }
  dots.draw(pane, {kDim, line});
  draw_mark(pane);
}

}  // namespace swiftlet::screen
