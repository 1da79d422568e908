// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/dds_log.hpp"

#include <fastdds/dds/log/Log.hpp>
#include <mutex>

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

}  // namespace

void bridge_dds_log() {
  static std::once_flag once;
  std::call_once(once, [] {
    dds::Log::ClearConsumers();
    dds::Log::RegisterConsumer(std::make_unique<LogBridge>());
  });
}

}  // namespace swiftlet
