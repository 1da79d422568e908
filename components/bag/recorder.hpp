// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/bag/mcap/writer.hpp"
#include "components/runtime/component.hpp"

namespace swiftlet {

struct RecorderParams {
  std::filesystem::path file;
  std::vector<std::string> topics;  ///< as in the file, with or without a leading '/'; empty: all
  bool overwrite = false;
};

/// Records topics as they travel, of known and unknown types, into an MCAP file that Foxglove and
/// `ros2 bag` read. Topics that appear while it runs are recorded from then on. Log time is the
/// time of the run at which a sample was taken from the middleware. A run with a vehicle records
/// the topics of that vehicle, without the vehicle in their names: Player puts one before them.
/// What cannot be written (disk full) ends the run with exit code 1.
class Recorder : public Component {
 public:
  /// Throws ConfigError where the file cannot be created.
  Recorder(const ComponentContext& context, const RecorderParams& params);

  /// Writes what is left and the summary.
  Status close();
  const mcap::Statistics& statistics() const { return writer_->statistics(); }
  /// Topics that were asked for and that nobody published.
  std::vector<std::string> missing() const;

 private:
  void look_for_topics();
  void record(const Endpoint& endpoint, const std::string& topic);
  void write(std::uint16_t channel, const Cdr& cdr);
  void check(const Status& status);

  RecorderParams params_;
  std::optional<mcap::Writer> writer_;
  std::map<std::string, std::string> recorded_;      // topics in the file, by those on the wire
  std::map<std::uint16_t, std::uint32_t> sequence_;  // by channel
};

/// The `offered_qos_profiles` of a channel, in the form of rosbag2.
std::string qos_metadata(const QosProfile& qos);

}  // namespace swiftlet
