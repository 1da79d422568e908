// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "components/runtime/qos.hpp"

namespace swiftlet {

/// One end of a topic that this process knows of: its own or a discovered one.
struct Endpoint {
  std::string id;     ///< unique in the domain (the DDS GUID)
  std::string topic;  ///< as on the wire: "rt/uav1/imu0"
  std::string type;   ///< as on the wire: "sensor_msgs::msg::dds_::Imu_"
  bool is_writer = false;
  QosProfile qos{};
  std::string component;                  ///< "" where the other end is not ours and does not say
  std::string participant;                ///< name of the process, or of its DDS participant
  std::vector<std::string> partitions{};  ///< none: the default one
};

/// Two ends of one topic that will never exchange a sample.
struct Conflict {
  Endpoint writer;
  Endpoint reader;
  std::string problem;  ///< policy, offered and requested; or the two types
};

/// All ends of all topics of the domain, kept up to date by discovery. Safe to use from any thread.
class Graph {
 public:
  /// Called once for each new pair that cannot communicate, from a thread of the middleware.
  using OnConflict = std::function<void(const Conflict&)>;
  explicit Graph(OnConflict on_conflict);

  void add(const Endpoint& endpoint);
  void remove(const std::string& id);

  std::vector<Endpoint> endpoints() const;
  /// The component of the endpoint with that id; "" where it is not known, or does not say.
  std::string component_of(const std::string& id) const;
  std::vector<Conflict> conflicts() const;

 private:
  OnConflict on_conflict_;
  mutable std::mutex mutex_;
  std::map<std::string, Endpoint> endpoints_;  // by id
};

/// For each topic that is written, one of its writers, with the weakest quality of service that all
/// of them offer: a reader that asks for no more hears every one.
std::map<std::string, Endpoint> weakest_offers(const std::vector<Endpoint>& endpoints);

/// "topic 'rt/imu0': writer 'sim' of swiftlet.12 and reader 'x' of swiftlet.13: reliability: ..."
std::string describe(const Conflict& conflict);

}  // namespace swiftlet
