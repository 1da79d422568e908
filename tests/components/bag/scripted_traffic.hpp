// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "components/runtime/component.hpp"
#include "components/runtime/host.hpp"
#include "tests/components/bag/mcap_test_files.hpp"

/// Traffic on real DDS that tests of the recorder and the player know byte for byte.
namespace swiftlet {

using mcap::Sample;

inline constexpr const char* kScanType = "sensor_msgs::msg::dds_::LaserScan_";
inline constexpr const char* kImuType = "sensor_msgs::msg::dds_::Imu_";
inline constexpr const char* kMapType = "nav_msgs::msg::dds_::OccupancyGrid_";

/// How a topic is offered: name and type as on the wire.
struct ScriptedTopic {
  std::string wire;
  std::string type;
  QosProfile qos = qos::state;
};

/// A sample of the form that DDS carries: the encapsulation of little-endian CDR, then anything.
inline Cdr random_cdr(std::mt19937& random, std::size_t largest) {
  Cdr cdr(4 + random() % largest);
  for (auto& byte : cdr) byte = static_cast<std::uint8_t>(random());
  cdr[0] = 0;
  cdr[1] = 1;
  cdr[2] = cdr[3] = 0;
  return cdr;
}

/// What is published: `topic` is an index into the topics, times are those of the run.
struct Publication {
  Time time{};
  std::size_t topic = 0;
  Cdr cdr;
};

/// In the order of time, three at each moment.
inline std::vector<Publication> random_publications(unsigned seed, std::size_t topics,
                                                    std::size_t count, Duration step) {
  std::mt19937 random(seed);
  std::vector<Publication> script(count);
  for (std::size_t i = 0; i < count; ++i) {
    script[i].time = Time(step * (1 + i / 3));
    script[i].topic = random() % topics;
    script[i].cdr = random_cdr(random, 300);
  }
  return script;
}

/// What a recording of the publications must hold.
inline std::vector<Sample> expected_samples(const std::vector<ScriptedTopic>& topics,
                                            const std::vector<Publication>& script) {
  std::vector<Sample> samples;
  std::map<std::size_t, std::uint32_t> sequence;
  for (const Publication& publication : script) {
    const mcap::Timestamp time = mcap::to_timestamp(publication.time);
    samples.push_back({topics[publication.topic].wire.substr(3), sequence[publication.topic]++,
                       time, time, publication.cdr});
  }
  return samples;
}

/// Publishes a script, and ends the run one second after its end.
class Script : public Component {
 public:
  Script(const ComponentContext& context, const std::vector<ScriptedTopic>& topics,
         std::vector<Publication> script)
      : Component(context), script_(std::move(script)) {
    for (const auto& [wire, type, qos] : topics) writers_.push_back(advertise_raw(wire, type, qos));
    schedule();
  }

 private:
  void schedule() {
    if (next_ == script_.size()) {
      call_at(now() + std::chrono::seconds(1), [this](Time) { stop(0); });
      return;
    }
    call_at(script_[next_].time, [this](Time now) {
      for (; next_ < script_.size() && script_[next_].time <= now; ++next_) {
        writers_[script_[next_].topic]->write(script_[next_].cdr);
      }
      schedule();
    });
  }

  std::vector<Publication> script_;
  std::size_t next_ = 0;
  std::vector<std::shared_ptr<Writer>> writers_;
};

/// Notes what arrives on some topics, and ends the run after `enough` samples.
class Listener : public Component {
 public:
  Listener(const ComponentContext& context, const std::vector<ScriptedTopic>& topics,
           std::size_t enough = SIZE_MAX)
      : Component(context), enough_(enough) {
    for (const ScriptedTopic& topic : topics) {
      subscribe_raw(topic.wire, topic.type, topic.qos, [this, name = topic.wire](const Cdr& cdr) {
        if (heard_.size() == enough_) return;
        const mcap::Timestamp time = mcap::to_timestamp(now());
        const auto sequence = static_cast<std::uint32_t>(heard_.size());
        heard_.push_back({name.substr(3), sequence, time, time, cdr});
        if (heard_.size() == enough_) stop(0);
      });
    }
  }
  const std::vector<Sample>& heard() const { return heard_; }

 private:
  std::size_t enough_;
  std::vector<Sample> heard_;
};

inline HostOptions lockstep_at(Time start = Time{}) {
  HostOptions options;
  options.lockstep = true;
  options.start = start;
  options.participant.domain = 76;  // nobody is heard in it but this process
  return options;
}

/// Topics, times and contents, without the counters.
inline std::vector<Sample> without_sequence(std::vector<Sample> samples) {
  for (Sample& sample : samples) sample.sequence = 0;
  return samples;
}

}  // namespace swiftlet
