// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "estimation/basics/result.hpp"

namespace swiftlet {

/// By what a name ends with.
enum class CloudForm {
  kPly,  ///< .ply, the Stanford triangle format, vertices alone
  kPcd,  ///< .pcd 0.7, of the Point Cloud Library
};
Result<CloudForm> cloud_form_of(const std::filesystem::path& file);

/// The bytes of a file: x, y and z [m] of each point as float32, binary and little-endian, behind a
/// header in ASCII.
std::string format_cloud(CloudForm form, const std::vector<Eigen::Vector3d>& points);

/// Writes it; the file appears whole, under its name, or not at all. Refuses an empty cloud.
Status save_cloud(const std::vector<Eigen::Vector3d>& points, const std::filesystem::path& file);

}  // namespace swiftlet
