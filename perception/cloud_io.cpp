// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/cloud_io.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>

#include "estimation/basics/whole_file.hpp"

namespace swiftlet {
namespace {

std::string header_of(CloudForm form, std::size_t count) {
  if (form == CloudForm::kPly) {
    return fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
        "property float y\nproperty float z\nend_header\n",
        count);
  }
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\n"
      "TYPE F F F\nCOUNT 1 1 1\nWIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\n"
      "DATA binary\n",
      count);
}

void append_little_endian(std::string& bytes, float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  for (int byte = 0; byte < 4; ++byte) bytes += static_cast<char>(bits >> 8 * byte & 0xffU);
}

}  // namespace

Result<CloudForm> cloud_form_of(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".ply") return CloudForm::kPly;
  if (extension == ".pcd") return CloudForm::kPcd;
  return Error{fmt::format("{}: a cloud is saved as .ply or .pcd", file.string())};
}

std::string format_cloud(CloudForm form, const std::vector<Eigen::Vector3d>& points) {
  std::string bytes = header_of(form, points.size());
  bytes.reserve(bytes.size() + 12 * points.size());
  for (const Eigen::Vector3d& point : points) {
    for (int axis = 0; axis < 3; ++axis) {
      append_little_endian(bytes, static_cast<float>(point[axis]));
    }
  }
  return bytes;
}

Status save_cloud(const std::vector<Eigen::Vector3d>& points, const std::filesystem::path& file) {
  const Result<CloudForm> form = cloud_form_of(file);
  if (!form.ok()) return form.error();
  if (points.empty()) {
    return Error{fmt::format("{}: the cloud is empty, there is nothing to save", file.string())};
  }
  return write_whole(file, format_cloud(*form, points));
}

}  // namespace swiftlet
