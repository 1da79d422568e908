// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Everything that can be done with the bytes of a recording.
#include "components/bag/mcap/reader.hpp"
#include "components/bag/mcap/repair.hpp"
#include "components/bag/mcap/salvage.hpp"
#include "components/bag/mcap/verify.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace swiftlet;

void read_all(const std::shared_ptr<const mcap::ByteSource>& source, bool use_index) {
  mcap::ReaderParams params;
  params.use_index = use_index;
  params.max_chunk_size = 1 << 20;  // what a few bytes of zstd may grow to
  const auto reader = mcap::Reader::open(source, params);
  if (!reader.ok()) return;
  for (const auto& index : reader->attachments()) (void)reader->read(index);
  for (const auto& index : reader->metadata()) (void)reader->read(index);
  auto cursor = reader->messages();
  mcap::Timestamp last = 0;
  std::size_t errors = 0;
  for (auto next = cursor.next(); !next.ok() || next->has_value(); next = cursor.next()) {
    if (!next.ok()) {
      fuzz::demand(++errors <= source->size(), "errors come to an end");
      continue;
    }
    fuzz::demand((*next)->channel != nullptr, "a message has a channel");
    fuzz::demand((*next)->message.log_time >= last, "messages come by time");
    last = (*next)->message.log_time;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto source = mcap::from_memory(mcap::Bytes(data, data + size), "fuzz.mcap");
  mcap::ReaderParams params;
  params.max_chunk_size = 1 << 20;
  (void)mcap::verify(source, params);
  (void)mcap::salvage(*source, params);
  for (const bool use_index : {true, false}) read_all(source, use_index);

  const fuzz::FileInMemory out(".mcap", nullptr, 0);
  const auto repaired = mcap::repair(*source, out.path(), "repair");
  if (repaired.ok()) {
    const auto file = mcap::open_file(out.path());
    fuzz::demand(file.ok(), "a repaired file is there");
    const auto found = mcap::verify(*file);
    fuzz::demand(found.ok(), "a repaired file can be verified");
    for (const std::string& problem : found->problems) {
      fuzz::demand(false, "a repaired file is sound", problem);
    }
  }
  return 0;
}
