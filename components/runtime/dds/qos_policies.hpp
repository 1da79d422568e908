// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastrtps/attributes/PublisherAttributes.h>
#include <fastrtps/attributes/SubscriberAttributes.h>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

#include <functional>
#include <map>
#include <string>

namespace swiftlet {

/// The policies of a Fast DDS profiles file that can be changed, by their place below the profile
/// ("qos/deadline/period"), and how the value that Fast DDS reads there changes ours.
template <class Attributes, class Qos>
using Policies = std::map<std::string, std::function<void(const Attributes&, Qos&)>>;

/// Changes nothing by itself: in DDS, partitions belong to the publisher or the subscriber.
inline constexpr const char* kPartitionPolicy = "qos/partition/names";

const Policies<eprosima::fastrtps::PublisherAttributes, eprosima::fastdds::dds::DataWriterQos>&
writer_policies();
const Policies<eprosima::fastrtps::SubscriberAttributes, eprosima::fastdds::dds::DataReaderQos>&
reader_policies();

}  // namespace swiftlet
