// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/introspection/topic_observer.hpp"
#include "components/runtime/reflection/field_path.hpp"

namespace swiftlet {

struct EchoParams {
  std::string topic;
  std::string field;  ///< "" for the whole message
  int count = 0;      ///< messages to print, 0: until the run ends
  bool json = false;  ///< a line a message, whole
  bool lists = true;
  bool full_length = false;
  const TypeLibrary* types = &TypeLibrary::built_in();
};

/// Prints the messages of a topic.
class Echo : public TopicObserver {
 public:
  Echo(const ComponentContext& context, const EchoParams& params);

  int printed() const { return printed_; }

 private:
  bool open(const TopicView& topic, const std::string& type) override;
  void sample(const Cdr& cdr, Time now) override;
  void print(const Value& value) const;

  EchoParams params_;
  const TypeDescription* type_ = nullptr;
  std::optional<FieldPath> field_;
  int printed_ = 0;
};

}  // namespace swiftlet
