// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "components/sim/shape.hpp"
#include "estimation/basics/result.hpp"

namespace swiftlet {

/// The triangles of a mesh file (.obj, .stl, .dae), each coordinate times `scale`, as a shape of
/// the kind kMesh that stands at the origin. As Gazebo does, the up axis of a .dae is not applied.
Result<Shape> read_mesh(const std::filesystem::path& file, const Eigen::Vector3d& scale);

}  // namespace swiftlet
