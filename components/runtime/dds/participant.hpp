// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "components/runtime/dds/network.hpp"
#include "components/runtime/graph.hpp"
#include "components/runtime/message.hpp"
#include "components/runtime/qos.hpp"
#include "components/runtime/runtime_error.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

class QosOverrides;

struct ParticipantOptions {
  std::string name = "swiftlet";  ///< of the process, as others see it
  int domain = 0;                 ///< DDS domain, 0 to 232
  NetworkConfig network;          ///< nothing leaves this machine by default
  /// Hear and be heard by this process alone: samples are then delivered in the writer's thread.
  bool isolated = false;
  /// Frames of plain types are shared with other processes of this machine. False: they are copied,
  /// as for processes that do not see the same /dev/shm.
  bool shares_memory = true;
  /// What the user's file changes of the quality of service; null: nothing.
  std::shared_ptr<const QosOverrides> qos_overrides;
};

/// The domain that ROS_DOMAIN_ID asks for, 0 where it is not set. Throws ConfigError where it is
/// not a whole number from 0 to 232.
int domain_from_environment();

/// The DDS GUID of a reader or writer: Endpoint::id, in a form that is cheap to compare.
using EndpointGuid = std::array<std::uint8_t, 16>;

/// The same as Endpoint::id has it.
std::string endpoint_id(const EndpointGuid& guid);

/// Where one sample came from.
struct SampleOrigin {
  EndpointGuid writer{};
  /// Counts what the writer wrote, from 1 on: a gap is what did not arrive.
  std::uint64_t sequence = 0;
  Time written{};  ///< on the system clock of the writer's host, in lockstep too
};

/// Sends samples of one topic. Not for use by several threads at once.
class Writer {
 public:
  virtual ~Writer() = default;
  /// `message` points to an object of the type that the writer was made for.
  virtual void write(const void* message) = 0;
  virtual void write(const Cdr& cdr) = 0;
  /// Memory for the next sample of a plain type, with unspecified content, where readers on this
  /// machine will find it. Null where the type is not plain, or all memory is lent: write a copy
  /// then. It must be given back by one of the two below.
  virtual void* loan() { return nullptr; }
  virtual void write_loan(void* /*sample*/) {}
  virtual void discard_loan(void* /*sample*/) {}
  /// Readers that get what is written, in whichever process.
  virtual int matched_readers() const = 0;
  /// Waits until every reliable reader has acknowledged what was written, for `limit` at most;
  /// false where one has not. At once where samples are delivered in the writer's thread.
  virtual bool wait_until_acknowledged(Duration /*limit*/) { return true; }
};

/// Holds the samples of one topic until they are taken.
class Reader {
 public:
  virtual ~Reader() = default;
  /// The oldest sample that was not taken yet; false where there is none. `message` points to an
  /// object of the type that the reader was made for.
  virtual bool take(void* message, SampleOrigin* origin = nullptr) = 0;
  virtual bool take(Cdr& cdr, SampleOrigin* origin = nullptr) = 0;
  /// Calls `use` with the oldest sample of a plain type, at the place where the writer put it,
  /// valid until `use` returns; false where there is none. A writer that is so far ahead that it
  /// needs the memory again overwrites it meanwhile: that is counted in overwritten(), and logged.
  virtual bool take_in_place(const std::function<void(const void*)>& use,
                             SampleOrigin* origin = nullptr) = 0;
  virtual std::uint64_t overwritten() const = 0;
  virtual int matched_writers() const = 0;
  /// Samples that wait at most; older ones are lost to the newer.
  virtual int depth() const = 0;
  /// Samples that DDS reports as lost on the way.
  virtual std::uint64_t lost() const = 0;
};

/// What one end of a topic is made from.
struct EndpointSpec {
  std::string topic;  ///< as on the wire: "rt/imu0"
  std::string type;   ///< as on the wire: "sensor_msgs::msg::dds_::Imu_"
  QosProfile qos;
  std::string component;  ///< who asks for it
  /// Null for types that the IDL files lack: those are only written and taken as CDR.
  const MessageType* message_type = nullptr;
};

/// A process's place in a DDS domain. Readers and writers keep it alive. Safe to use from any
/// thread.
class Participant {
 public:
  explicit Participant(const ParticipantOptions& options);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  std::unique_ptr<Writer> make_writer(const EndpointSpec& spec);
  /// `on_sample` is called for each sample that arrives, by a thread of the middleware (or by the
  /// writer's, in an isolated participant); it must only take note.
  std::unique_ptr<Reader> make_reader(const EndpointSpec& spec, std::function<void()> on_sample);

  const Graph& graph() const;
  /// Unique in the domain (the prefix of the DDS GUID).
  const std::string& id() const;

 private:
  class Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace swiftlet
