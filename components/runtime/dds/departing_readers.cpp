// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/departing_readers.hpp"

#include <dlfcn.h>
#include <fastdds/rtps/history/WriterHistory.h>
#include <fastdds/rtps/writer/ReaderProxy.h>
#include <fastdds/rtps/writer/StatefulWriter.h>

#include <mutex>

namespace {

using eprosima::fastrtps::rtps::GUID_t;
using eprosima::fastrtps::rtps::StatefulWriter;

constexpr const char* kName =
    "_ZN8eprosima8fastrtps4rtps14StatefulWriter21matched_reader_removeERKNS1_6GUID_tE";

/// A member function that is not virtual is called like a function of the object and the rest.
using Remove = bool (*)(StatefulWriter*, const GUID_t&);

Remove library_remove() {
  static const auto found = reinterpret_cast<Remove>(dlsym(RTLD_NEXT, kName));
  return found;
}

}  // namespace

namespace eprosima::fastrtps::rtps {

bool StatefulWriter::matched_reader_remove(const GUID_t& reader_guid) {
  const std::lock_guard<RecursiveTimedMutex> lock(mp_mutex);
  for (ReaderProxy* reader : matched_remote_readers_) {
    if (reader->guid() != reader_guid) continue;
    reader->acked_changes_set(mp_history->next_sequence_number());
  }
  check_acked_status();
  return library_remove()(this, reader_guid);
}

}  // namespace eprosima::fastrtps::rtps

namespace swiftlet {

bool departing_readers_are_settled() {
  const auto chosen = reinterpret_cast<Remove>(dlsym(RTLD_DEFAULT, kName));
  return library_remove() != nullptr && chosen != library_remove();
}

}  // namespace swiftlet
