// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using swiftlet_frames::msg::Cloud256k;
using swiftlet_frames::msg::Image1M;
using swiftlet_frames::msg::Image640k;
using swiftlet_frames::msg::Image80k;
using ::testing::Each;
using ::testing::HasSubstr;

constexpr Time kStamp{Duration(12'345'678'901)};

template <class Frame>
std::unique_ptr<Frame> used_before() {
  auto frame = std::make_unique<Frame>();
  frame->data().fill(0xAB);
  return frame;
}

TEST(ImageFrame, HoldsTheImagesThatTheVehicleHas) {
  EXPECT_TRUE(describe(kStamp, {"flow", "mono8", 64, 64}, *used_before<Image80k>()).ok());
  EXPECT_TRUE(describe(kStamp, {"flow", "mono8", 320, 240}, *used_before<Image80k>()).ok());
  EXPECT_TRUE(describe(kStamp, {"depth", "16UC1", 640, 480}, *used_before<Image640k>()).ok());
  EXPECT_TRUE(describe(kStamp, {"camera", "rgb8", 640, 480}, *used_before<Image1M>()).ok());
}

TEST(ImageFrame, WhatIsDescribedIsReadAndTheRestIsZero) {
  const auto frame = used_before<Image80k>();
  ASSERT_TRUE(describe(kStamp, {"flow", "mono8", 100, 50, 128}, *frame).ok());
  const auto shape = shape_of(*frame);
  ASSERT_TRUE(shape.ok());
  EXPECT_EQ(shape->frame_id, "flow");
  EXPECT_EQ(shape->encoding, "mono8");
  EXPECT_EQ(shape->width, 100u);
  EXPECT_EQ(shape->height, 50u);
  EXPECT_EQ(shape->step, 128u);
  EXPECT_EQ(from_msg(frame->info().stamp()), kStamp);
  const auto& data = frame->data();
  EXPECT_EQ(data[128 * 50 - 1], 0xAB) << "rows are the caller's";
  EXPECT_THAT(std::vector<int>(data.begin() + 128 * 50, data.end()), Each(0));
}

TEST(ImageFrame, WhatDoesNotFitIsRefusedWithNumbers) {
  const auto frame = used_before<Image80k>();
  const auto reason = [&](const ImageShape& shape) {
    const Status status = describe(kStamp, shape, *frame);
    return status.ok() ? "" : status.error().reason;
  };
  EXPECT_THAT(reason({"x", "rgb8", 320, 240}), HasSubstr("230400 bytes, the frame has 81920"));
  EXPECT_THAT(reason({"x", "mono8", 320, 240, 319}), HasSubstr("need 320 bytes, not 319"));
  EXPECT_THAT(reason({"x", "jpeg", 10, 10}), HasSubstr("'jpeg'"));
  EXPECT_THAT(reason({std::string(33, 'x'), "mono8", 10, 10}), HasSubstr("32 bytes"));
}

TEST(ImageFrame, NoGarbageInItsInfoIsBelieved) {
  std::mt19937 random(5);
  const auto frame = std::make_unique<Image80k>();
  const std::uint32_t extremes[] = {0, 1, 320, 65536, 0x80000000U, 0xFFFFFFFFU};
  std::uniform_int_distribution<std::size_t> pick(0, std::size(extremes) - 1);
  int accepted = 0;
  for (int i = 0; i < 2000; ++i) {
    ASSERT_TRUE(describe(kStamp, {"x", "16UC1", 1, 1}, *frame).ok());
    frame->info().width(extremes[pick(random)]);
    frame->info().height(extremes[pick(random)]);
    frame->info().step(extremes[pick(random)]);
    const auto image = to_image(*frame);
    if (!image.ok()) continue;
    ++accepted;
    ASSERT_LE(std::uint64_t{image->step()} * image->height(), frame->data().size());
    ASSERT_GE(image->step(), std::uint64_t{image->width()} * 2);
    ASSERT_EQ(image->data().size(), std::uint64_t{image->step()} * image->height());
  }
  EXPECT_GT(accepted, 0);
}

TEST(ImageFrame, BecomesAnImageForViewers) {
  const auto frame = used_before<Image640k>();
  ASSERT_TRUE(describe(kStamp, {"depth", "16UC1", 4, 2}, *frame).ok());
  for (std::uint8_t i = 0; i < 16; ++i) frame->data()[i] = i;
  const auto image = to_image(*frame);
  ASSERT_TRUE(image.ok());
  EXPECT_EQ(from_msg(image->header().stamp()), kStamp);
  EXPECT_EQ(image->header().frame_id(), "depth");
  EXPECT_EQ(image->encoding(), "16UC1");
  EXPECT_EQ(image->width(), 4u);
  EXPECT_EQ(image->height(), 2u);
  EXPECT_EQ(image->step(), 8u);
  EXPECT_EQ(image->is_bigendian(), 0);
  ASSERT_EQ(image->data().size(), 16u);
  for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(image->data()[i], i);
}

TEST(CloudFrame, BecomesAPointCloudThatKnowsItsFields) {
  const auto frame = std::make_unique<Cloud256k>();
  frame->points().fill(7.0F);
  ASSERT_TRUE(describe(kStamp, "laser", 2, *frame).ok());
  EXPECT_EQ(frame->points()[8], 0.0F);
  const float values[8] = {1.0F, 2.0F, 3.0F, 0.5F, -1.0F, -2.0F, -3.0F, 0.25F};
  std::copy(std::begin(values), std::end(values), frame->points().begin());
  const auto cloud = to_point_cloud(*frame);
  ASSERT_TRUE(cloud.ok());
  EXPECT_EQ(cloud->width() * cloud->height(), 2u);
  EXPECT_TRUE(cloud->is_dense());
  ASSERT_EQ(cloud->fields().size(), 4u);
  for (std::size_t point = 0; point < 2; ++point) {
    for (std::size_t i = 0; i < 4; ++i) {
      float value = 0.0F;
      std::memcpy(&value, &cloud->data()[point * cloud->point_step() + cloud->fields()[i].offset()],
                  sizeof(value));
      EXPECT_EQ(value, values[4 * point + i]) << cloud->fields()[i].name();
    }
  }
  frame->points()[5] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(to_point_cloud(*frame)->is_dense());
  frame->info().count(16385);
  EXPECT_FALSE(to_point_cloud(*frame).ok());
  EXPECT_FALSE(describe(kStamp, "laser", 16385, *frame).ok());
}

}  // namespace
}  // namespace swiftlet
