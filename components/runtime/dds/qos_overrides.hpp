// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace eprosima::fastdds::dds {
class DataReaderQos;
class DataWriterQos;
}  // namespace eprosima::fastdds::dds

namespace swiftlet {

/// What a user's Fast DDS profiles file changes of our quality of service:
///
///     <dds><profiles>
///       <data_writer profile_name="sensor"> ... </data_writer>   all topics of that profile
///       <data_reader profile_name="imu0"> ... </data_reader>     one topic; it wins
///     </profiles></dds>
///
/// Only the policies that stand there change, all others stay as they are.
class QosOverrides {
 public:
  struct Names {
    std::vector<std::string> topics;  ///< that exist, without "rt/" and without vehicle
    std::string vehicle;              ///< whose topics a name without "rt/" means
  };

  /// Throws ConfigError, with file and line, where the file is not one of profiles, has a value
  /// that Fast DDS cannot read, changes what cannot be changed here, or has a profile that is
  /// neither one of ours nor a topic.
  static QosOverrides load(const std::string& file, const Names& names);

  /// Changes `qos` of a writer of that topic (as on the wire) that has that profile.
  void apply(const std::string& topic, const std::string& profile,
             eprosima::fastdds::dds::DataWriterQos& qos) const;
  void apply(const std::string& topic, const std::string& profile,
             eprosima::fastdds::dds::DataReaderQos& qos) const;
  /// Partitions that a writer or a reader is put into. (In DDS they belong to its publisher or
  /// subscriber.)
  std::vector<std::string> writer_partitions(const std::string& topic,
                                             const std::string& profile) const;
  std::vector<std::string> reader_partitions(const std::string& topic,
                                             const std::string& profile) const;

 private:
  template <class Qos>
  struct Changes {
    std::vector<std::function<void(Qos&)>> policies;
    std::vector<std::string> partitions;
  };
  template <class Qos>
  using ByName = std::map<std::string, Changes<Qos>>;  // profile, or topic as on the wire

  friend class QosOverridesReader;
  ByName<eprosima::fastdds::dds::DataWriterQos> writers_;
  ByName<eprosima::fastdds::dds::DataReaderQos> readers_;
};

}  // namespace swiftlet
