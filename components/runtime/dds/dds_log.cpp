// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/dds_log.hpp"

#include <fastdds/dds/log/Log.hpp>
#include <memory>

#include "components/runtime/log.hpp"

namespace swiftlet {

namespace dds = eprosima::fastdds::dds;

namespace {

/// What Fast DDS has to say goes to our log, not to standard output.
class LogBridge : public dds::LogConsumer {
 public:
  void Consume(const dds::Log::Entry& entry) override {
    const bool is_error = entry.kind == dds::Log::Kind::Error;
    logger("dds")->log(is_error ? spdlog::level::warn : spdlog::level::debug, "{} ({})",
                       entry.message,
                       entry.context.category == nullptr ? "" : entry.context.category);
  }
};

/// The bridge while it stands. Fast DDS logs in a thread of its own that outlives main(): it must
/// be cut off before our loggers are gone.
class Bridge {
 public:
  Bridge() {
    logger("dds");  // what is made before this is destroyed after it
    dds::Log::ClearConsumers();
    dds::Log::RegisterConsumer(std::make_unique<LogBridge>());
  }
  ~Bridge() { dds::Log::ClearConsumers(); }  // after what waits has been told
  Bridge(const Bridge&) = delete;
  Bridge& operator=(const Bridge&) = delete;
};

}  // namespace

void bridge_dds_log() {
  static const Bridge bridge;
}

}  // namespace swiftlet
