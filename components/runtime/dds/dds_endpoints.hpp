// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>

#include <functional>
#include <memory>

#include "components/runtime/dds/participant.hpp"

namespace swiftlet {

/// Makes DDS's readers and writers, and removes them: a participant.
class EndpointFactory {
 public:
  virtual ~EndpointFactory() = default;
  virtual eprosima::fastdds::dds::DataWriter* make_writer(const EndpointSpec& spec) = 0;
  virtual eprosima::fastdds::dds::DataReader* make_reader(
      const EndpointSpec& spec, eprosima::fastdds::dds::DataReaderListener* listener) = 0;
  virtual void remove(eprosima::fastdds::dds::DataWriter* writer) = 0;
  virtual void remove(eprosima::fastdds::dds::DataReader* reader) = 0;
};

/// Our Writer and Reader on DDS; they keep the factory alive.
std::unique_ptr<Writer> make_dds_writer(std::shared_ptr<EndpointFactory> factory,
                                        const EndpointSpec& spec);
std::unique_ptr<Reader> make_dds_reader(std::shared_ptr<EndpointFactory> factory,
                                        const EndpointSpec& spec, std::function<void()> on_sample);

}  // namespace swiftlet
