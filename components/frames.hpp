// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "components/conversions.hpp"
#include "components/runtime/plain_types.hpp"
#include "estimation/basics/result.hpp"

/// What a component does with frames: describes what it writes, checks what it reads, and makes a
/// ROS 2 message of it for viewers.
namespace swiftlet {

/// What an image is. `step`: bytes from one row to the next; 0: rows without gaps.
struct ImageShape {
  std::string frame_id;
  std::string encoding =
      "mono8";  ///< as in sensor_msgs/Image: mono8, mono16, 16UC1, 32FC1, rgb8, bgr8
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t step = 0;
};

/// Bytes of one pixel of an encoding; 0 for those that we do not know.
std::uint32_t bytes_per_pixel(std::string_view encoding);

/// Text that stands in a fixed array, up to its first zero.
template <std::size_t N>
std::string text_of(const std::array<std::uint8_t, N>& bytes) {
  return {bytes.begin(), std::find(bytes.begin(), bytes.end(), std::uint8_t{0})};
}

/// Says what image the frame holds; call it first, then fill in the rows. The rest of the frame
/// becomes zero, so that what a frame holds, and a recording of it, does not depend on what lay in
/// its memory before. Refuses an image that does not fit.
Status describe(Time stamp, const ImageShape& shape, swiftlet_frames::msg::ImageInfo& info,
                std::uint8_t* data, std::size_t capacity);
template <class Frame>
Status describe(Time stamp, const ImageShape& shape, Frame& frame) {
  return describe(stamp, shape, frame.info(), frame.data().data(), frame.data().size());
}

/// The shape of a received image; the reason where it is not one: a frame is memory that another
/// program wrote.
Result<ImageShape> shape_of(const swiftlet_frames::msg::ImageInfo& info, std::size_t capacity);
template <class Frame>
Result<ImageShape> shape_of(const Frame& frame) {
  return shape_of(frame.info(), frame.data().size());
}

/// For viewers: a copy in ROS 2's shape.
Result<sensor_msgs::msg::Image> to_image(const swiftlet_frames::msg::ImageInfo& info,
                                         const std::uint8_t* data, std::size_t capacity);
template <class Frame>
Result<sensor_msgs::msg::Image> to_image(const Frame& frame) {
  return to_image(frame.info(), frame.data().data(), frame.data().size());
}

/// The same for clouds. `count` points of x, y, z [m] and intensity follow one another.
Status describe(Time stamp, const std::string& frame_id, std::uint32_t count,
                swiftlet_frames::msg::CloudInfo& info, float* points, std::size_t capacity);
template <class Frame>
Status describe(Time stamp, const std::string& frame_id, std::uint32_t count, Frame& frame) {
  return describe(stamp, frame_id, count, frame.info(), frame.points().data(),
                  frame.points().size());
}
Result<sensor_msgs::msg::PointCloud2> to_point_cloud(const swiftlet_frames::msg::CloudInfo& info,
                                                     const float* points, std::size_t capacity);
template <class Frame>
Result<sensor_msgs::msg::PointCloud2> to_point_cloud(const Frame& frame) {
  return to_point_cloud(frame.info(), frame.points().data(), frame.points().size());
}

}  // namespace swiftlet
