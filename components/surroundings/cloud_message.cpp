// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/surroundings/cloud_message.hpp"

#include <array>
#include <cstring>
#include <string>

namespace swiftlet {
namespace {

namespace datatype = sensor_msgs::msg::PointField_Constants;

/// Where one coordinate is in the bytes of a point.
struct Field {
  std::size_t offset = 0;
  bool is_double = false;
  std::size_t end() const { return offset + (is_double ? sizeof(double) : sizeof(float)); }
};

Result<Field> find_field(const sensor_msgs::msg::PointCloud2& cloud, const std::string& name) {
  for (const auto& field : cloud.fields()) {
    if (field.name() != name) continue;
    const bool is_double = field.datatype() == datatype::FLOAT64;
    if (!is_double && field.datatype() != datatype::FLOAT32) {
      return Error{"its field '" + name + "' is neither float32 nor float64"};
    }
    const Field found{field.offset(), is_double};
    if (found.end() > cloud.point_step()) {
      return Error{"its field '" + name + "' lies behind the end of a point"};
    }
    return found;
  }
  return Error{"it has no field '" + name + "'"};
}

double read(const std::uint8_t* point, const Field& field) {
  if (field.is_double) {
    double value = 0.0;
    std::memcpy(&value, point + field.offset, sizeof(value));
    return value;
  }
  float value = 0.0F;
  std::memcpy(&value, point + field.offset, sizeof(value));
  return static_cast<double>(value);
}

}  // namespace

Result<std::vector<Eigen::Vector3d>> points_of(const sensor_msgs::msg::PointCloud2& cloud) {
  if (cloud.is_bigendian()) return Error{"it is big-endian"};
  std::array<Field, 3> fields;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Result<Field> field = find_field(cloud, std::string(1, "xyz"[axis]));
    if (!field.ok()) return field.error();
    fields[axis] = *field;
  }
  const std::size_t width = cloud.width(), height = cloud.height(), row = cloud.row_step();
  const std::size_t step = cloud.point_step();
  if (width > 0 && height > 0 && (row / step < width || cloud.data().size() / row < height)) {
    return Error{"it has fewer bytes than its size wants"};
  }
  std::vector<Eigen::Vector3d> points;
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::uint8_t* bytes = cloud.data().data() + y * row + x * step;
      const Eigen::Vector3d point(read(bytes, fields[0]), read(bytes, fields[1]),
                                  read(bytes, fields[2]));
      if (point.allFinite()) points.push_back(point);
    }
  }
  return points;
}

}  // namespace swiftlet
