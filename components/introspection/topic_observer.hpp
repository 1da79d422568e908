// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "components/introspection/observer.hpp"

namespace swiftlet {

/// Reads one topic that others write, whatever its type. It asks for the weakest quality of service
/// that the writers offer, so that it hears them all. A topic that nobody writes ends the run.
class TopicObserver : public Observer {
 public:
  TopicObserver(const ComponentContext& context, std::string topic);

 protected:
  /// Before the first sample; `type` as on the wire. False where the topic is of no use.
  virtual bool open(const TopicView& topic, const std::string& type) = 0;
  virtual void sample(const Cdr& cdr, Time now) = 0;

 private:
  void begin(const GraphView& view) final;
  void warn_if_silent();

  std::string topic_;
  TopicView found_;
  bool heard_ = false;
};

}  // namespace swiftlet
