// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/log.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <mutex>

namespace swiftlet {

Logger logger(const std::string& name) {
  // Two threads may ask for a new one at the same moment.
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  static const auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
  if (Logger existing = spdlog::get(name)) return existing;
  auto created = std::make_shared<spdlog::logger>(name, sink);
  created->set_pattern("[%H:%M:%S.%e] [%^%l%$] %n: %v");
  spdlog::initialize_logger(created);
  return created;
}

bool set_log_level(const std::string& level) {
  const auto parsed = spdlog::level::from_str(level);
  if (parsed == spdlog::level::off && level != "off") return false;
  spdlog::set_level(parsed);
  return true;
}

}  // namespace swiftlet
