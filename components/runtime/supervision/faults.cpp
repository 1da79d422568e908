// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/supervision/faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <regex>

#include "components/runtime/config/config.hpp"

namespace swiftlet {
namespace {

/// Digits with at most one point; the pattern lets nothing else through.
Duration seconds(const std::string& text) {
  return from_seconds(std::stod(text));
}

/// Loses or delays what is written.
class FaultyWriter : public Writer {
 public:
  FaultyWriter(std::shared_ptr<Writer> writer, const Fault& fault, std::uint64_t seed, Time begin,
               const MessageType* type, Mailbox& mailbox, const Executor& executor)
      : writer_(std::move(writer)),
        fault_(fault),
        begin_(begin),
        type_(type),
        mailbox_(mailbox),
        executor_(executor),
        random_(seed) {}

  void write(const void* message) override {
    if (!strikes()) return writer_->write(message);
    if (fault_.kind == Fault::Kind::kDrop) return;
    Cdr cdr(type_->serialized_size(message));
    cdr.resize(type_->serialize(message, cdr.data(), cdr.size()));
    send_later(std::move(cdr));
  }

  void write(const Cdr& cdr) override {
    if (!strikes()) return writer_->write(cdr);
    if (fault_.kind == Fault::Kind::kDelay) send_later(cdr);
  }

  int matched_readers() const override { return writer_->matched_readers(); }
  bool wait_until_acknowledged(Duration limit) override {
    return writer_->wait_until_acknowledged(limit);
  }

 private:
  bool strikes() {
    const Duration time = executor_.now() - begin_;
    if (time < fault_.begin || time >= fault_.end) return false;
    return fault_.kind == Fault::Kind::kDelay || uniform_(random_) < fault_.probability;
  }

  void send_later(Cdr cdr) {
    mailbox_.call_at(executor_.now() + fault_.delay,
                     [writer = writer_, cdr = std::move(cdr)](Time) { writer->write(cdr); });
  }

  std::shared_ptr<Writer> writer_;
  Fault fault_;
  Time begin_;
  const MessageType* type_;
  Mailbox& mailbox_;
  const Executor& executor_;
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> uniform_;
};

/// The same on every machine, which std::hash need not be.
std::uint64_t hash_of(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return hash;
}

}  // namespace

Fault parse_fault(const std::string& text) {
  // Numbers are short enough to stay within the range of times.
  static const std::regex kill(R"(\s*kill\s+([A-Za-z_]\w*)\s*@\s*(\d{1,6}(?:\.\d{0,9})?)\s*s?\s*)");
  static const std::regex delay(
      R"(\s*delay\s+([\w/]+)\s+(\d{1,6}(?:\.\d{0,9})?)\s*(ms|s)(?:\s*@\s*(\d{1,6}(?:\.\d{0,9})?)\.\.(\d{1,6}(?:\.\d{0,9})?))?\s*)");
  static const std::regex drop(
      R"(\s*drop\s+([\w/]+)\s+(\d{1,6}(?:\.\d{0,9})?)\s*%(?:\s*@\s*(\d{1,6}(?:\.\d{0,9})?)\.\.(\d{1,6}(?:\.\d{0,9})?))?\s*)");
  std::smatch part;
  Fault fault;
  const auto read_window = [&](std::size_t first) {
    if (!part[first].matched) return;
    fault.begin = seconds(part[first]);
    fault.end = seconds(part[first + 1]);
  };
  if (std::regex_match(text, part, kill)) {
    fault.kind = Fault::Kind::kKill;
    fault.begin = seconds(part[2]);
  } else if (std::regex_match(text, part, delay)) {
    fault.kind = Fault::Kind::kDelay;
    fault.delay = part[3] == "ms" ? seconds(part[2]) / 1000 : seconds(part[2]);
    read_window(4);
  } else if (std::regex_match(text, part, drop) && std::stod(part[2]) <= 100.0) {
    fault.kind = Fault::Kind::kDrop;
    fault.probability = std::stod(part[2]) / 100.0;
    read_window(3);
  } else {
    throw ConfigError(
        fmt::format("--what-if \"{}\": cannot be read; write \"kill estimator@12.5\", \"delay scan "
                    "80ms\" or \"drop imu0 20%\", the last two with \"@3..4.5\" for a time",
                    text));
  }
  fault.target = part[1];
  if (fault.end <= fault.begin) {
    throw ConfigError(fmt::format("--what-if \"{}\": it ends before it begins", text));
  }
  return fault;
}

std::shared_ptr<Writer> FaultPlan::apply(std::shared_ptr<Writer> writer, const std::string& topic,
                                         const MessageType* type, Mailbox& mailbox,
                                         const Executor& executor) {
  topics_.insert(topic);
  for (const Fault& fault : faults_) {
    if (fault.kind == Fault::Kind::kKill || fault.target != topic) continue;
    writer = std::make_shared<FaultyWriter>(std::move(writer), fault, seed_ ^ hash_of(topic),
                                            begin_, type, mailbox, executor);
  }
  return writer;
}

void FaultPlan::finish(const std::vector<std::string>& components) const {
  for (const Fault& fault : faults_) {
    const bool kill = fault.kind == Fault::Kind::kKill;
    const std::vector<std::string> known =
        kill ? components : std::vector<std::string>(topics_.begin(), topics_.end());
    if (std::find(known.begin(), known.end(), fault.target) != known.end()) continue;
    const std::string near = nearest_word(fault.target, known);
    throw ConfigError(fmt::format("--what-if: {} '{}' is not in this run; {}",
                                  kill ? "component" : "topic", fault.target,
                                  near.empty() ? fmt::format("there are {}", fmt::join(known, ", "))
                                               : fmt::format("did you mean '{}'?", near)));
  }
}

}  // namespace swiftlet
