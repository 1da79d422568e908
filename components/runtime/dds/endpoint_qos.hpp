// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/publisher/qos/WriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/subscriber/qos/ReaderQos.hpp>
#include <string>
#include <vector>

#include "components/runtime/dds/participant.hpp"
#include "components/runtime/dds/qos_overrides.hpp"

namespace swiftlet {

/// Where an endpoint lives.
struct EndpointPlace {
  bool isolated = false;  ///< nothing leaves the process
  bool shared = false;    ///< a plain type, in memory that other processes of this machine see, too
  bool leaves_machine = false;  ///< over links that may be slow, or at a limited pace
};

/// Our profile in Fast DDS's terms, with what the user's file changes of it (null: nothing).
eprosima::fastdds::dds::DataWriterQos writer_qos(const EndpointSpec& spec,
                                                 const EndpointPlace& place,
                                                 const QosOverrides* overrides);
eprosima::fastdds::dds::DataReaderQos reader_qos(const EndpointSpec& spec,
                                                 const EndpointPlace& place,
                                                 const QosOverrides* overrides);

/// The inverse: what a reader or writer really has. `profile` lends its name, and what DDS does not
/// know.
QosProfile profile_of(const eprosima::fastdds::dds::DataWriterQos& qos, const QosProfile& profile);
QosProfile profile_of(const eprosima::fastdds::dds::DataReaderQos& qos, const QosProfile& profile);
/// The same of what discovery tells about an endpoint elsewhere.
QosProfile discovered_profile(const eprosima::fastdds::dds::WriterQos& qos);
QosProfile discovered_profile(const eprosima::fastdds::dds::ReaderQos& qos);

/// What an endpoint tells about itself in DDS's user data: "component=sim;depth=32;". Discovery has
/// no other place for either.
std::string announcement(const std::string& component, int depth);
struct Announcement {
  std::string component;  ///< "" where the endpoint is not ours
  int depth = 0;          ///< 0 where it is not known
};
Announcement read_announcement(const std::vector<std::uint8_t>& user_data);

}  // namespace swiftlet
