// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "components/bag/loss_ledger.hpp"
#include "components/runtime/dds/participant.hpp"
#include "components/runtime/execution/sample_task.hpp"

namespace swiftlet {

/// Takes the samples of one topic as bytes, one each time it is its turn, so that samples of
/// different topics are heard in the order in which they arrived.
///
/// A DDS reader has room for a number of samples, whatever their size, and where one is missing on
/// the way, a reliable reader keeps all behind it. So one whose samples turn out to be large is
/// replaced by one with room for fewer; the old one goes when the new one hears. That is not done
/// for writers of this process: a reader that goes while such a writer writes takes what the others
/// still wait for with it (Fast DDS 2.9).
class TopicReader : public SampleTask {
 public:
  /// `missing`: samples of the same writer that did not arrive before this one.
  using OnSample = std::function<void(Cdr cdr, const SampleOrigin& origin, std::uint64_t missing)>;

  /// `max_bytes`: of samples that wait in DDS; 0: as many as the depth of the quality of service.
  TopicReader(Mailbox& mailbox, Participant& participant, const EndpointSpec& spec,
              std::uint64_t max_bytes, OnSample on_sample);

 private:
  bool take_one() override;
  std::unique_ptr<Reader> make_reader();
  bool take(Cdr& cdr, SampleOrigin& origin);
  void limit_memory(std::size_t sample, const EndpointGuid& writer);

  Participant& participant_;
  EndpointSpec spec_;
  const std::uint64_t max_bytes_;
  OnSample on_sample_;
  SequenceWatch watch_;
  bool replaced_ = false;
  std::unique_ptr<Reader> old_;  // until the new one hears
  std::unique_ptr<Reader> reader_;
};

}  // namespace swiftlet
