// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "components/sim/shape.hpp"
#include "estimation/basics/result.hpp"

namespace swiftlet {

/// What a plan view shows. Positions in the world [m]; x points right and y up in the picture.
struct PlanView {
  std::string title;                        ///< first line
  std::string subtitle;                     ///< second line, smaller
  std::vector<Outline> outlines;            ///< World::slice at the height of flight
  std::vector<Outline> low_outlines;        ///< things below the flight, drawn faint
  std::vector<Outline> obstacles;           ///< what the scenario added, drawn in red
  std::vector<Eigen::Vector3d> flown;       ///< positions over time
  std::vector<double> flown_speed;          ///< [m/s] of each; empty: the path has one colour
  std::vector<Eigen::Vector3d> reference;   ///< what was to be flown
  std::vector<Eigen::Vector2d> waypoints;   ///< numbered from 1
  std::vector<Eigen::Vector2d> collisions;  ///< places of contact
  Eigen::Vector2d pad = Eigen::Vector2d::Zero();
  double pad_size = 0.6;      ///< side of the pad [m]; zero for none
  int pixels_per_metre = 80;  ///< made smaller where the picture would be wider than 4000 pixels
};

/// Draws `view` into a PNG file. What is not finite is left out. Fails, with the reason, where
/// there is nothing to draw or the file cannot be written.
Status draw_plan_view(const PlanView& view, const std::filesystem::path& file);

}  // namespace swiftlet
