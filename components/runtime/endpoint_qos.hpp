// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

#include "components/runtime/participant.hpp"

namespace swiftlet {

/// Our profile in Fast DDS's terms. `shared`: of a plain type, in memory that other processes of
/// this machine see, too.
eprosima::fastdds::dds::DataWriterQos writer_qos(const EndpointSpec& spec, bool shared,
                                                 bool isolated);
eprosima::fastdds::dds::DataReaderQos reader_qos(const EndpointSpec& spec, bool shared);

}  // namespace swiftlet
