// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/recorder.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "components/bag/recording_records.hpp"
#include "components/runtime/names.hpp"
#include "components/runtime/reflection/idl_schema.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

/// Samples of a topic that may wait in DDS until their turn: half a second of the fastest sensor.
constexpr int kDepth = 512;
/// Where samples are large, those may take this part of the memory.
constexpr std::uint64_t kReaderShare = 8;
/// A crash costs at most what came since the last flush, and what still waits.
constexpr Duration kFlushPeriod = 500ms;
/// Once samples have waited so long, they are written without compression, which is several times
/// faster, until they wait no longer than kInTime.
constexpr Duration kLate = 150ms;
constexpr Duration kInTime = 50ms;

/// What a recording calls a topic; nothing where it is not of this vehicle.
std::optional<std::string> topic_in_file(const std::string& vehicle, const std::string& wire) {
  std::string topic = topic_of(vehicle, wire);
  const bool is_own = vehicle.empty() || wire_topic(vehicle, topic) == wire;
  return is_own ? std::make_optional(std::move(topic)) : std::nullopt;
}

/// What ROS 2 uses beneath its topics: who is there, and service calls.
bool is_plumbing(const std::string& wire) {
  if (wire == "ros_discovery_info") return true;
  const std::string prefix = wire.substr(0, 3);
  return prefix == "rq/" || prefix == "rr/" || prefix == "rs/";
}

std::map<std::string, std::string> run_metadata(const ComponentContext& context,
                                                const RecorderParams& params) {
  std::map<std::string, std::string> run = params.run;
  run[kRunStartKey] = std::to_string(mcap::to_timestamp(context.executor->now()));
  run["vehicle"] = context.vehicle;
  run["domain"] = std::to_string(context.domain);
  run["lockstep"] = context.executor->is_lockstep() ? "true" : "false";
  run["version"] = SWIFTLET_VERSION;
  return run;
}

}  // namespace

Recorder::Recorder(const ComponentContext& context, const RecorderParams& params)
    : Component(context),
      params_(params),
      selection_({params.topics, params.regexes, params.exclude}),
      lockstep_(context.executor->is_lockstep()) {
  writer_params_.file = params.file;
  writer_params_.overwrite = params.overwrite;
  writer_params_.compression = params.compression;
  writer_params_.start = mcap::to_timestamp(now());
  writer_params_.run = run_metadata(context, params);
  open();
  look_for_topics();
  every(100ms, [this](Time) { tick(); });
  every(kFlushPeriod, [this](Time) { flush(); });
}

Recorder::~Recorder() = default;

void Recorder::open() {
  const bool is_split = params_.split_size > 0 || params_.split_duration > Duration(0);
  if (params_.window > Duration(0)) {
    if (is_split) throw ConfigError("a window cannot be split: leave one of the two options out");
    const auto folder = params_.file.parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder)) {
      throw ConfigError(params_.file.string() + ": there is no folder " + folder.string());
    }
    // While one window is written, the next one is there beside it.
    window_.emplace(params_.window, params_.max_memory / 2);
    background_.emplace(params_.max_memory, [](const RecordedSample&) { return Status(); });
    return;
  }
  RecordingWriterParams params = writer_params_;
  params.split_size = params_.split_size;
  params.split_duration = params_.split_duration;
  auto opened = RecordingWriter::open(params);
  if (!opened.ok()) throw ConfigError(opened.error().reason);
  writer_.emplace(std::move(opened).value());
  background_.emplace(params_.max_memory,
                      [this](const RecordedSample& sample) { return write(sample); });
}

/// In the thread of background_.
Status Recorder::write(const RecordedSample& sample) {
  if (!lockstep_) {
    const Duration waited = now() - mcap::to_time(sample.log_time);
    const bool was_in_haste = std::exchange(in_haste_, waited > (in_haste_ ? kInTime : kLate));
    if (in_haste_ != was_in_haste) {
      writer_->set_compression(in_haste_ ? mcap::Compression::kNone : params_.compression);
    }
  }
  return writer_->write(sample);
}

Status Recorder::close() {
  readers_.clear();
  if (writer_ && files_.empty()) {
    background_->post([this, losses = losses_, time = mcap::to_timestamp(now())] {
      const Status noted = writer_->note(losses, time);
      const Status closed = writer_->close();
      return noted.ok() ? closed : noted;
    });
  }
  const Status done = background_->drain();
  if (writer_) {
    if (!done.ok()) (void)writer_->close();
    files_ = writer_->files();
  }
  return done.ok() ? save_failure_ : done;
}

Recorder::Progress Recorder::progress() const {
  Progress progress;
  progress.topics = topic_count_;
  progress.messages = message_count_;
  progress.bytes = byte_count_;
  progress.queued_bytes = window_ ? window_bytes_.load() : background_->queued_bytes();
  progress.lost_by_dds = lost_by_dds_;
  progress.dropped = dropped_;
  progress.saved = saved_;
  return progress;
}

std::vector<std::string> Recorder::missing() const {
  std::vector<std::string> names;
  for (const RecordedTopic& topic : topics_) names.push_back(topic.name);
  return selection_.missing(names);
}

void Recorder::look_for_topics() {
  for (const auto& [wire, endpoint] : weakest_offers(context().participant->graph().endpoints())) {
    if (!known_.insert(wire).second) continue;
    const auto topic = topic_in_file(context().vehicle, wire);
    if (topic && !is_plumbing(wire) && selection_.wants(*topic)) record(endpoint, *topic);
  }
}

void Recorder::record(const Endpoint& endpoint, const std::string& name) {
  RecordedTopic topic;
  topic.name = name;
  topic.type = ros_type_name(endpoint.type);
  topic.latched = endpoint.qos.transient_local;
  topic.metadata = {{"offered_qos_profiles", qos_metadata(endpoint.qos)}};
  if (!endpoint.component.empty()) topic.metadata[kChannelComponentKey] = endpoint.component;
  const auto idl = idl_schema(topic.type);
  if (idl.ok()) {
    topic.schema_encoding = "ros2idl";
    topic.schema = *idl;
  } else {
    // MCAP's way to give a type's name alone is a schema without encoding.
    log()->warn("{} has the type {}, which this program does not know: recorded without its IDL",
                name, topic.type);
  }
  // Ask for no more than is offered.
  QosProfile qos = endpoint.qos;
  qos.depth = std::max(qos.depth, kDepth);
  add(std::move(topic));
  // In lockstep each sample is taken before the next one is written.
  const std::uint64_t limit = lockstep_ ? 0 : params_.max_memory / kReaderShare;
  readers_.push_back(std::make_unique<TopicReader>(
      mailbox(), *context().participant,
      EndpointSpec{endpoint.topic, endpoint.type, qos, Component::name(), nullptr}, limit,
      [this, topic = topics_.size() - 1](Cdr cdr, const SampleOrigin& origin,
                                         std::uint64_t missing) {
        if (missing > 0) {
          losses_[topics_[topic].name].by_dds += missing;
          lost_by_dds_ += missing;
        }
        keep(topic_of_writer(topic, origin.writer), origin, std::move(cdr));
      }));
  topic_count_ = readers_.size();
}

void Recorder::add(RecordedTopic topic) {
  if (writer_) background_->post([this, topic] { return writer_->add_topic(topic); });
  topics_.push_back(std::move(topic));
  sequence_.push_back(0);
}

/// `topic` itself, or another of that name for what another component writes.
std::size_t Recorder::topic_of_writer(std::size_t topic, const EndpointGuid& writer) {
  const auto known = topic_by_writer_.find(writer);
  if (known != topic_by_writer_.end()) return known->second;
  const std::string component = context().participant->graph().component_of(endpoint_id(writer));
  RecordedTopic own = topics_[topic];
  if (!component.empty()) own.metadata[kChannelComponentKey] = component;
  std::size_t place = 0;
  while (place < topics_.size() &&
         (topics_[place].name != own.name || topics_[place].metadata != own.metadata)) {
    ++place;
  }
  if (place == topics_.size()) add(std::move(own));
  topic_by_writer_.emplace(writer, place);
  return place;
}

void Recorder::keep(std::size_t topic, const SampleOrigin& origin, Cdr cdr) {
  ++message_count_;
  byte_count_ += cdr.size();
  RecordedSample sample;
  sample.topic = topic;
  sample.sequence = sequence_[topic];
  sample.log_time = mcap::to_timestamp(now());
  sample.publish_time = lockstep_ ? sample.log_time : mcap::to_timestamp(origin.written);
  sample.writer = origin.writer;
  sample.data = std::move(cdr);
  if (window_) {
    window_->add(std::move(sample), topics_[topic].latched);
    window_bytes_ = window_->bytes();
  } else if (lockstep_) {
    background_->push(std::move(sample));
  } else if (!background_->offer(std::move(sample))) {
    ++losses_[topics_[topic].name].by_recorder;
    ++dropped_;
    return;
  }
  ++sequence_[topic];
}

void Recorder::tick() {
  look_for_topics();
  report_drops();
  if (save_requested_.exchange(false)) save_window();
  // In lockstep the moment at which the thread meets an error is not that of the run.
  if (!lockstep_) check(background_->failure());
}

void Recorder::report_drops() {
  if (window_) {
    if (window_->is_cut_short() && !std::exchange(window_was_cut_, true)) {
      log()->warn(
          "the window is shorter than asked for: {} MB are full; raise --max-memory or "
          "record fewer topics",
          params_.max_memory / 2'000'000);
    }
    return;
  }
  const std::uint64_t drops = dropped_;
  if (drops > seen_drops_) {
    last_drop_ = now();
    seen_drops_ = drops;
    if (!std::exchange(dropping_, true)) {
      log()->warn(
          "samples are being dropped: {} MB wait to be written and more do not fit; is "
          "the disk too slow?",
          background_->queued_bytes() / 1'000'000);
    }
  } else if (dropping_ && now() - last_drop_ >= 1s) {
    dropping_ = false;
    log()->warn("no more samples are being dropped; {} were",
                drops - std::exchange(reported_drops_, drops));
  }
}

void Recorder::flush() {
  const mcap::Timestamp time = mcap::to_timestamp(now());
  if (window_) return window_->note(losses_, time);
  background_->post([this, losses = losses_, time] {
    const Status noted = writer_->note(losses, time);
    return noted.ok() ? writer_->flush() : noted;
  });
  if (lockstep_) check(background_->drain());
}

void Recorder::save_window() {
  if (!window_) return;
  if (saving_.exchange(true)) {  // each holds the memory of its samples
    log()->warn("the window before is still being saved; ask again when it is done");
    return;
  }
  const mcap::Timestamp time = mcap::to_timestamp(now());
  window_->note(losses_, time);
  background_->post([this, file = window_file(params_.file, now()), topics = topics_,
                     content = window_->content(time)] {
    const auto written = write_window(content, file, topics);
    if (written.ok()) {
      log()->info("saved {}", *written);
      files_.push_back(file);
      ++saved_;
    } else {
      log()->error("the window was not saved: {}", written.error().reason);
      save_failure_ = written.error();
    }
    saving_ = false;
    return Status();  // the next one may find room on the disk
  });
  if (lockstep_) check(background_->drain());
}

Result<std::string> Recorder::write_window(const SampleWindow::Content& content,
                                           const std::filesystem::path& file,
                                           const std::vector<RecordedTopic>& topics) {
  RecordingWriterParams params = writer_params_;
  params.file = file;
  auto writer = RecordingWriter::open(params);
  if (!writer.ok()) return writer.error();
  for (const RecordedTopic& topic : topics) {
    if (const Status added = writer->add_topic(topic); !added.ok()) return added.error();
  }
  Status done = writer->repeat(content.latched, content.begin);
  for (const auto& sample : content.samples) {
    if (done.ok()) done = writer->write(*sample);
  }
  const mcap::Timestamp end =
      content.samples.empty() ? content.begin : content.samples.back()->log_time;
  if (done.ok()) done = writer->note(content.losses, end);
  if (done.ok()) done = writer->close();
  if (!done.ok()) return done.error();
  return fmt::format("{}: {} messages of {:.1f} s", file.string(), writer->messages(),
                     1e-9 * static_cast<double>(end - content.begin));
}

void Recorder::check(const Status& status) {
  if (status.ok() || std::exchange(stopped_, true)) return;
  log()->error("recording stopped: {}", status.error().reason);
  stop(1);
}

std::filesystem::path window_file(const std::filesystem::path& file, Time time) {
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(time.time_since_epoch());
  const auto seconds = static_cast<std::time_t>(ms.count() / 1000);
  const std::string name =
      fmt::format("{}_{:%Y%m%dT%H%M%S}.{:03}Z{}", file.stem().string(), fmt::gmtime(seconds),
                  ms.count() % 1000, file.extension().string());
  return file.parent_path() / name;
}

std::string qos_metadata(const QosProfile& qos) {
  // Numbers as rmw defines them. Infinite durations are rmw's, too.
  constexpr const char* kInfinite = "\n    sec: 9223372036\n    nsec: 854775807\n";
  return fmt::format(
      "- history: 1\n  depth: {}\n  reliability: {}\n  durability: {}\n  deadline:{}"
      "  lifespan:{}  liveliness: 1\n  liveliness_lease_duration:{}"
      "  avoid_ros_namespace_conventions: false",
      qos.depth, qos.reliable ? 1 : 2, qos.transient_local ? 1 : 2, kInfinite, kInfinite,
      kInfinite);
}

}  // namespace swiftlet
