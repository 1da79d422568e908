// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "components/introspection/graph_view.hpp"
#include "components/runtime/component.hpp"

namespace swiftlet {

/// A look at the graph from outside. It waits until the graph has come to rest, which is when no
/// end was found for a while, and then begins. The wait is short enough for every answer to come
/// within a second.
class Observer : public Component {
 public:
  explicit Observer(const ComponentContext& context);

  /// Why it stopped without being done; "" where it did not.
  const std::string& problem() const { return problem_; }
  /// What was there when it began.
  const GraphView& first_view() const { return first_view_; }
  const std::string& vehicle() const { return context().vehicle; }

 protected:
  /// The graph is at rest.
  virtual void begin(const GraphView& view) = 0;

  GraphView view() const { return view_of(graph(), name(), context().process); }
  /// Ends the run; `problem` is for the person who asked.
  void give_up(const std::string& problem, int exit_code = 1);

 private:
  const Graph& graph() const { return context().participant->graph(); }
  void look(Time now);

  Time start_;
  Time changed_;
  std::size_t seen_ = 0;
  bool begun_ = false;
  GraphView first_view_;
  std::string problem_;
};

/// "is anything running in domain 7? ...": what to do where nothing is seen.
std::string nothing_there(int domain);

}  // namespace swiftlet
