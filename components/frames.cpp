// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/frames.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

namespace swiftlet {
namespace {

constexpr std::size_t kFloatsPerPoint = 4;  // x, y, z, intensity

struct Encoding {
  std::string_view name;
  std::uint32_t bytes_per_pixel;
};
constexpr Encoding kEncodings[] = {{"mono8", 1}, {"8UC1", 1}, {"mono16", 2}, {"16UC1", 2},
                                   {"32FC1", 4}, {"rgb8", 3}, {"bgr8", 3},   {"8UC3", 3},
                                   {"rgba8", 4}, {"bgra8", 4}};

template <std::size_t N>
Status set_text(const std::string& text, const char* what, std::array<std::uint8_t, N>& bytes) {
  if (text.size() > N || text.find('\0') != text.npos) {
    return Error{fmt::format("{} '{}' does not fit into {} bytes", what, text, N)};
  }
  std::fill(std::copy(text.begin(), text.end(), bytes.begin()), bytes.end(), std::uint8_t{0});
  return {};
}

std_msgs::msg::Header header_of(const builtin_interfaces::msg::Time& stamp,
                                const std::array<std::uint8_t, 32>& frame_id) {
  std_msgs::msg::Header header;
  header.stamp(stamp);
  header.frame_id(text_of(frame_id));
  return header;
}

/// Bytes that an image occupies; the reason where it cannot be.
Result<std::uint64_t> size_of(const ImageShape& shape, std::size_t capacity) {
  const std::uint32_t pixel = bytes_per_pixel(shape.encoding);
  if (pixel == 0) return Error{fmt::format("the encoding '{}' is not known", shape.encoding)};
  // In 64 bits: what another program wrote may be any number.
  const std::uint64_t row = std::uint64_t{shape.width} * pixel;
  if (shape.step < row) {
    return Error{fmt::format("rows of {} pixels of {} need {} bytes, not {}", shape.width,
                             shape.encoding, row, shape.step)};
  }
  const std::uint64_t size = std::uint64_t{shape.step} * shape.height;
  if (size > capacity) {
    return Error{fmt::format("{} x {} {} needs {} bytes, the frame has {}", shape.width,
                             shape.height, shape.encoding, size, capacity)};
  }
  return size;
}

}  // namespace

std::uint32_t bytes_per_pixel(std::string_view encoding) {
  const auto* found = std::find_if(std::begin(kEncodings), std::end(kEncodings),
                                   [&](const Encoding& known) { return known.name == encoding; });
  return found == std::end(kEncodings) ? 0 : found->bytes_per_pixel;
}

Status describe(Time stamp, const ImageShape& wanted, swiftlet_frames::msg::ImageInfo& info,
                std::uint8_t* data, std::size_t capacity) {
  ImageShape shape = wanted;
  if (shape.step == 0) shape.step = shape.width * bytes_per_pixel(shape.encoding);
  const auto size = size_of(shape, capacity);
  if (!size.ok()) return size.error();
  if (const Status done = set_text(shape.frame_id, "frame_id", info.frame_id()); !done.ok()) {
    return done;
  }
  if (const Status done = set_text(shape.encoding, "encoding", info.encoding()); !done.ok()) {
    return done;
  }
  info.stamp(to_msg(stamp));
  info.width(shape.width);
  info.height(shape.height);
  info.step(shape.step);
  std::memset(data + *size, 0, capacity - *size);
  return {};
}

Result<ImageShape> shape_of(const swiftlet_frames::msg::ImageInfo& info, std::size_t capacity) {
  ImageShape shape{text_of(info.frame_id()), text_of(info.encoding()), info.width(), info.height(),
                   info.step()};
  const auto size = size_of(shape, capacity);
  if (!size.ok()) return size.error();
  return shape;
}

Result<sensor_msgs::msg::Image> to_image(const swiftlet_frames::msg::ImageInfo& info,
                                         const std::uint8_t* data, std::size_t capacity) {
  const auto shape = shape_of(info, capacity);
  if (!shape.ok()) return shape.error();
  sensor_msgs::msg::Image image;
  image.header(header_of(info.stamp(), info.frame_id()));
  image.encoding(shape->encoding);
  image.width(shape->width);
  image.height(shape->height);
  image.step(shape->step);
  image.data().assign(data, data + std::size_t{shape->step} * shape->height);
  return image;
}

Status describe(Time stamp, const std::string& frame_id, std::uint32_t count,
                swiftlet_frames::msg::CloudInfo& info, float* points, std::size_t capacity) {
  if (count > capacity / kFloatsPerPoint) {
    return Error{fmt::format("a cloud of {} points does not fit into a frame for {}", count,
                             capacity / kFloatsPerPoint)};
  }
  if (const Status done = set_text(frame_id, "frame_id", info.frame_id()); !done.ok()) return done;
  info.stamp(to_msg(stamp));
  info.count(count);
  std::fill(points + count * kFloatsPerPoint, points + capacity, 0.0F);
  return {};
}

Result<sensor_msgs::msg::PointCloud2> to_point_cloud(const swiftlet_frames::msg::CloudInfo& info,
                                                     const float* points, std::size_t capacity) {
  if (info.count() > capacity / kFloatsPerPoint) {
    return Error{fmt::format("a cloud of {} points in a frame for {}", info.count(),
                             capacity / kFloatsPerPoint)};
  }
  constexpr auto kPointBytes = static_cast<std::uint32_t>(kFloatsPerPoint * sizeof(float));
  sensor_msgs::msg::PointCloud2 cloud;
  cloud.header(header_of(info.stamp(), info.frame_id()));
  cloud.height(1);
  cloud.width(info.count());
  for (const char* name : {"x", "y", "z", "intensity"}) {
    sensor_msgs::msg::PointField field;
    field.name(name);
    field.offset(static_cast<std::uint32_t>(cloud.fields().size() * sizeof(float)));
    field.datatype(sensor_msgs::msg::PointField_Constants::FLOAT32);
    field.count(1);
    cloud.fields().push_back(field);
  }
  cloud.point_step(kPointBytes);
  cloud.row_step(kPointBytes * info.count());
  cloud.data().resize(cloud.row_step());
  std::memcpy(cloud.data().data(), points, cloud.data().size());
  cloud.is_dense(std::all_of(points, points + info.count() * kFloatsPerPoint,
                             [](float value) { return std::isfinite(value); }));
  return cloud;
}

}  // namespace swiftlet
