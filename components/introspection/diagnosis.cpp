// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "components/introspection/observer.hpp"
#include "components/runtime/config/nearest_word.hpp"
#include "components/runtime/message.hpp"
#include "components/runtime/names.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using Findings = std::vector<Finding>;

std::string last_part(const std::string& topic, std::size_t parts) {
  std::size_t at = topic.size();
  for (std::size_t i = 0; i < parts && at != std::string::npos; ++i) {
    at = at == 0 ? std::string::npos : topic.rfind('/', at - 1);
  }
  return at == std::string::npos ? topic : topic.substr(at + 1);
}

/// Topics that somebody writes only when there is something to say, or in some vehicles: one
/// without an explorer, a guard, a claw or GPS is well, and the commander says what is missing when
/// it is to explore.
bool is_written_on_demand(const std::string& wire) {
  static const std::set<std::string> topics{topic::mode.name,
                                            topic::waypoints.name,
                                            topic::goal_pose.name,
                                            topic::mode_ack.name,
                                            topic::goal.name,
                                            topic::exploration.name,
                                            topic::manual_control.name,
                                            topic::gcs_heartbeat.name,
                                            topic::guard_setpoint.name,
                                            topic::guard_status.name,
                                            topic::gps_fix.name,
                                            topic::parameter_request.name,
                                            topic::parameter_reply.name,
                                            topic::mission_upload.name,
                                            topic::mission_fetch.name,
                                            topic::mission_download.name,
                                            topic::claw_command.name,
                                            topic::claw_state.name,
                                            topic::claw_servo.name,
                                            topic::claw_feedback.name,
                                            topic::telemetry.name};
  const std::string name = topic_of("", wire);
  return topics.count(name) != 0 || topics.count(last_part(name, 1)) != 0 ||
         topics.count(last_part(name, 2)) != 0;
}

bool of_vehicle(const std::string& wire, const std::string& vehicle) {
  return vehicle.empty() || wire_topic(vehicle, topic_of(vehicle, wire)) == wire;
}

void find_conflicts(const Evidence& evidence, Findings& findings) {
  for (const Conflict& conflict : evidence.graph.conflicts) {
    if (!of_vehicle(conflict.writer.topic, evidence.vehicle)) continue;
    const bool type = conflict.writer.type != conflict.reader.type;
    findings.push_back(
        {type ? "type" : "qos", true,
         fmt::format("nothing flows on '{}' from {} to {}: {}",
                     topic_of(evidence.vehicle, conflict.writer.topic), who(conflict.writer),
                     who(conflict.reader), conflict.problem),
         type ? "let both use the same type, or give one of them another topic"
              : "let the writer offer what the reader requests, or the reader request no more than "
                "is offered"});
  }
}

/// A written topic whose name says that it could be the one that is missed.
std::string likely_topic(const TopicView& missed, const std::vector<TopicView>& topics) {
  std::vector<std::string> written;
  for (const TopicView& topic : topics) {
    if (topic.writers.empty() || topic.types.front() != missed.types.front()) continue;
    // The same topic of another vehicle, or of none.
    if (last_part(topic.name, 1) == last_part(missed.name, 1)) return topic.name;
    written.push_back(topic.name);
  }
  return nearest_word(missed.name, written);
}

std::set<std::string> find_unwritten(const Evidence& evidence, Findings& findings) {
  std::set<std::string> names;
  const auto topics = topics_of(evidence.graph, evidence.vehicle);
  for (const TopicView& topic : topics) {
    if (!topic.writers.empty() || is_hidden(topic.wire) || is_written_on_demand(topic.wire)) {
      continue;
    }
    std::vector<Endpoint> ours;
    for (const Endpoint& reader : topic.readers) {
      if (!reader.component.empty()) ours.push_back(reader);
    }
    if (ours.empty()) continue;  // a viewer of somebody else may wait as it likes
    const std::string likely = likely_topic(topic, topics_of(evidence.graph, ""));
    findings.push_back(
        {"unwritten", true,
         fmt::format("'{}' [{}] is read by {}, and nobody writes it", topic.name,
                     fmt::join(topic.types, ", "), who(ours)),
         likely.empty()
             ? "start the component that writes it"
             : fmt::format("'{}' is written: is --vehicle the same everywhere?", likely)});
    names.insert(topic.name);
  }
  return names;
}

/// Topics in `unwritten` have a finding already, which says more than their readers can.
void find_component_problems(const Evidence& evidence, const std::set<std::string>& unwritten,
                             Findings& findings) {
  std::map<std::string, std::vector<const Instance*>> active;
  for (const Instance& instance : evidence.instances) {
    const std::string name = instance.name(evidence.vehicle);
    const std::string subject = fmt::format("{} of process {}", name, instance.process);
    if (instance.silent(evidence.now)) {
      findings.push_back(
          {"silent", true,
           fmt::format("{} was last heard {:.2f} s ago, and shows that it lives every "
                       "{:.0f} ms",
                       subject, to_seconds(evidence.now - instance.heard),
                       to_seconds(instance.period) * 1e3),
           "look at its log; it was killed, or hangs"});
      continue;
    }
    for (const std::string& problem : instance.problems) {
      if (unwritten.count(problem.substr(0, problem.find(": nobody writes it"))) != 0) continue;
      findings.push_back({"problem", true, fmt::format("{}: {}", subject, problem),
                          fmt::format("see: swiftlet component info {}", name)});
    }
    if (instance.has_status && instance.active) active[name].push_back(&instance);
  }
  for (const auto& [name, instances] : active) {
    if (instances.size() < 2) continue;
    std::vector<std::string> processes;
    for (const Instance* instance : instances) processes.push_back(instance->process);
    findings.push_back({"two active", true,
                        fmt::format("{} is active in {} processes: {}", name, instances.size(),
                                    fmt::join(processes, ", ")),
                        "stop all but one, or start the others with --standby 1 and so on; if they "
                        "were, they do not hear each other"});
  }
}

/// Components that announce their status topic and say nothing on it.
void find_mute(const Evidence& evidence, Findings& findings) {
  for (const Endpoint& endpoint : evidence.graph.endpoints) {
    const bool is_status = endpoint.is_writer && !endpoint.component.empty() &&
                           is_status_topic(endpoint.topic) && !is_hidden(endpoint.topic) &&
                           of_vehicle(endpoint.topic, evidence.vehicle);
    if (!is_status) continue;
    const bool heard = std::any_of(
        evidence.instances.begin(), evidence.instances.end(), [&](const Instance& instance) {
          return instance.has_status && instance.component == endpoint.component &&
                 instance.process == endpoint.participant;
        });
    if (heard) continue;
    findings.push_back({"silent", true,
                        fmt::format("{} has not shown that it lives", who(endpoint)),
                        "look at its log; it hangs, or its messages do not get through"});
  }
}

/// A participant none of whose ends names a component is not ours.
void find_unknown(const Evidence& evidence, Findings& findings) {
  std::map<std::string, std::vector<const Endpoint*>> participants;  // by GUID prefix
  for (const Endpoint& endpoint : evidence.graph.endpoints) {
    participants[endpoint.id.substr(0, endpoint.id.find('|'))].push_back(&endpoint);
  }
  for (const auto& [prefix, ends] : participants) {
    const bool ours = std::any_of(ends.begin(), ends.end(), [](const Endpoint* endpoint) {
      return !endpoint->component.empty();
    });
    if (ours) continue;
    std::set<std::string> writes;
    std::set<std::string> reads;
    for (const Endpoint* end : ends) {
      if (is_hidden(end->topic)) continue;
      (end->is_writer ? writes : reads).insert(topic_of(evidence.vehicle, end->topic));
    }
    std::string text = fmt::format("participant '{}' ({}) is not one of Swiftlet's",
                                   ends.front()->participant, prefix);
    if (!writes.empty()) text += fmt::format("; it writes {}", fmt::join(writes, ", "));
    if (!reads.empty()) text += fmt::format("; it reads {}", fmt::join(reads, ", "));
    findings.push_back({"unknown participant", false, text,
                        "nothing, if you know it (ROS 2, a viewer); else take another domain"});
  }
}

}  // namespace

Findings diagnose(const Evidence& evidence) {
  Findings findings;
  if (evidence.graph.endpoints.empty()) {
    return {{"nothing", true, fmt::format("nothing is seen in domain {}", evidence.domain),
             nothing_there(evidence.domain)}};
  }
  if (!evidence.vehicle.empty() && topics_of(evidence.graph, evidence.vehicle).empty()) {
    findings.push_back(
        {"nothing", true,
         fmt::format("vehicle '{}' has no topics in domain {}", evidence.vehicle, evidence.domain),
         "see: swiftlet topic list, without --vehicle"});
  }
  find_conflicts(evidence, findings);
  const std::set<std::string> unwritten = find_unwritten(evidence, findings);
  find_component_problems(evidence, unwritten, findings);
  find_mute(evidence, findings);
  find_unknown(evidence, findings);
  return findings;
}

std::string findings_text(const Findings& findings, const Evidence& evidence) {
  std::string text;
  std::size_t problems = 0;
  for (const Finding& finding : findings) {
    if (finding.is_problem) ++problems;
    text += fmt::format("{}: {}\n  remedy: {}\n", finding.is_problem ? "PROBLEM" : "note",
                        finding.text, finding.remedy);
  }
  std::set<std::string> processes;
  std::size_t running = 0;
  std::set<std::string> topics;
  for (const Endpoint& end : evidence.graph.endpoints) {
    processes.insert(end.participant);
    if (!is_hidden(end.topic)) topics.insert(end.topic);
  }
  for (const Instance& instance : evidence.instances) running += instance.has_status ? 1 : 0;
  return text + fmt::format("{} ({} components, {} processes, {} topics)\n",
                            problems == 0   ? "healthy"
                            : problems == 1 ? "1 problem"
                                            : fmt::format("{} problems", problems),
                            running, processes.size(), topics.size());
}

nlohmann::ordered_json findings_json(const Findings& findings) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  bool healthy = true;
  for (const Finding& finding : findings) {
    healthy = healthy && !finding.is_problem;
    array.push_back({{"kind", finding.kind},
                     {"problem", finding.is_problem},
                     {"text", finding.text},
                     {"remedy", finding.remedy}});
  }
  return {{"healthy", healthy}, {"findings", array}};
}

}  // namespace swiftlet
