// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "components/bag/background_writer.hpp"
#include "components/bag/recording_writer.hpp"
#include "components/bag/sample_window.hpp"
#include "components/bag/topic_reader.hpp"
#include "components/bag/topic_selection.hpp"
#include "components/runtime/component.hpp"

namespace swiftlet {

struct RecorderParams {
  std::filesystem::path file;
  std::vector<std::string> topics;  ///< as in TopicPatterns; empty: all
  bool overwrite = false;
  std::vector<std::string> regexes{};                        ///< as in TopicPatterns
  std::vector<std::string> exclude{};                        ///< as in TopicPatterns
  mcap::Compression compression = mcap::Compression::kZstd;  ///< of chunks
  std::uint64_t split_size = 0;            ///< [bytes]; as in RecordingWriterParams
  Duration split_duration{0};              ///< as in RecordingWriterParams
  Duration window{0};                      ///< keep so much in memory, write it when asked; 0: off
  std::uint64_t max_memory = 256'000'000;  ///< for samples that wait or are kept [bytes]
  std::map<std::string, std::string> run{};  ///< goes into the metadata record kRunRecord
};

/// Records topics as they travel, of known and unknown types, into an MCAP file that Foxglove and
/// `ros2 bag` read. Topics that appear while it runs are recorded from then on. Log time is the
/// time of the run at which a sample was taken from the middleware, publish time that at which its
/// writer says that it was written (in lockstep: the log time). A run with a vehicle records the
/// topics of that vehicle, without the vehicle in their names: Player puts one before them.
///
/// A thread of its own compresses and writes; while it is late, it only writes. Live, samples that find no room in front of it are
/// dropped; like those that DDS lost, they are counted in the file's ledger and told of in the log.
/// In lockstep nothing is dropped: the run waits. What cannot be written (disk full) ends the run
/// with exit code 1.
///
/// With a window, samples stay in memory until save() writes those of the last moments into a file
/// with the time in its name.
class Recorder : public Component {
 public:
  /// Throws ConfigError where the file cannot be created or the topics make no sense.
  Recorder(const ComponentContext& context, const RecorderParams& params);
  ~Recorder() override;

  /// Writes what is left and the summary. After the run.
  Status close();
  /// Writes the window soon. From any thread.
  void save() { save_requested_ = true; }

  /// How it goes. From any thread.
  struct Progress {
    std::uint64_t topics = 0;
    std::uint64_t messages = 0;      ///< taken from the middleware
    std::uint64_t bytes = 0;         ///< of these, as they travelled
    std::uint64_t queued_bytes = 0;  ///< wait to be written, or are kept in the window
    std::uint64_t lost_by_dds = 0;
    std::uint64_t dropped = 0;  ///< by the recorder
    std::uint64_t saved = 0;    ///< windows
  };
  Progress progress() const;

  /// By topic. After the run.
  const LossLedger& losses() const { return losses_; }
  /// What was written. After close().
  const std::vector<std::filesystem::path>& files() const { return files_; }
  /// Topics that were asked for and that nobody published.
  std::vector<std::string> missing() const;

 private:
  void open();
  void look_for_topics();
  void record(const Endpoint& endpoint, const std::string& topic);
  void add(RecordedTopic topic);
  std::size_t topic_of_writer(std::size_t topic, const EndpointGuid& writer);
  void keep(std::size_t topic, const SampleOrigin& origin, Cdr cdr);
  Status write(const RecordedSample& sample);
  void flush();
  void tick();
  void report_drops();
  void save_window();
  Result<std::string> write_window(const SampleWindow::Content& content,
                                   const std::filesystem::path& file,
                                   const std::vector<RecordedTopic>& topics);
  void check(const Status& status);

  RecorderParams params_;
  TopicSelection selection_;
  bool lockstep_;
  RecordingWriterParams writer_params_;
  std::set<std::string> known_;        // topics on the wire that were looked at
  std::vector<RecordedTopic> topics_;  // in the file, one for each component that writes it
  std::map<EndpointGuid, std::size_t> topic_by_writer_;
  std::vector<std::uint32_t> sequence_;  // by topic
  LossLedger losses_;
  std::optional<SampleWindow> window_;
  bool window_was_cut_ = false;
  Status save_failure_;    // set by the thread of background_
  bool in_haste_ = false;  // used by the thread of background_ alone
  bool stopped_ = false;
  std::uint64_t reported_drops_ = 0;  // when their end was logged last
  std::uint64_t seen_drops_ = 0;
  Time last_drop_{};
  bool dropping_ = false;

  std::atomic<bool> save_requested_{false};
  std::atomic<bool> saving_{false};
  std::atomic<std::uint64_t> topic_count_{0};
  std::atomic<std::uint64_t> message_count_{0};
  std::atomic<std::uint64_t> byte_count_{0};
  std::atomic<std::uint64_t> lost_by_dds_{0};
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<std::uint64_t> window_bytes_{0};
  std::atomic<std::uint64_t> saved_{0};

  std::vector<std::filesystem::path> files_;
  std::optional<RecordingWriter> writer_;  // used by the thread of background_ alone
  std::optional<BackgroundWriter> background_;
  std::vector<std::unique_ptr<TopicReader>> readers_;  // last: nothing arrives any more
};

/// The `offered_qos_profiles` of a channel, in the form of rosbag2.
std::string qos_metadata(const QosProfile& qos);

/// "flight_20260712T101530.123Z.mcap" of "flight.mcap": a window that was saved at that time.
std::filesystem::path window_file(const std::filesystem::path& file, Time time);

}  // namespace swiftlet
