// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Samples as Cyclone DDS has decoded them, as JSON: with the names of the IDL files, and numbers in
// the form of `swiftlet topic echo --json`.
#pragma once

#include <nlohmann/json.hpp>

#include "nav_msgs.h"
#include "rmw_dds_common.h"
#include "sensor_msgs.h"
#include "tf2_msgs.h"

namespace swiftlet::test {

using Json = nlohmann::ordered_json;

Json json_of(const nav_msgs_msg_OccupancyGrid& message);
Json json_of(const nav_msgs_msg_Odometry& message);
Json json_of(const nav_msgs_msg_Path& message);
Json json_of(const rmw_dds_common_msg_ParticipantEntitiesInfo& message);
Json json_of(const sensor_msgs_msg_Image& message);
Json json_of(const sensor_msgs_msg_LaserScan& message);
Json json_of(const sensor_msgs_msg_PointCloud2& message);
Json json_of(const tf2_msgs_msg_TFMessage& message);

}  // namespace swiftlet::test
