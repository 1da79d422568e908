// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/content_hash.hpp"

#include <fmt/format.h>

#include "components/bag/mcap/reader.hpp"

namespace swiftlet {
namespace {

class Fnv1a {
 public:
  void add(mcap::ByteView bytes) {
    for (std::size_t i = 0; i < bytes.size; ++i) {
      hash_ ^= bytes.data[i];
      hash_ *= 0x100000001b3ULL;
    }
  }
  void add(std::uint64_t number) {
    for (int i = 0; i < 8; ++i) {
      const auto byte = static_cast<std::uint8_t>(number >> (8 * i));
      add(mcap::ByteView(&byte, 1));
    }
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

}  // namespace

Result<std::string> content_hash(const std::filesystem::path& file) {
  const auto reader = mcap::Reader::open(file);
  if (!reader.ok()) return reader.error();
  Fnv1a hash;
  auto messages = reader->messages();
  for (;;) {
    const auto next = messages.next();
    if (!next.ok()) return next.error();
    if (!*next) return fmt::format("{:016x}", hash.value());
    const mcap::MessageView& view = **next;
    // Lengths go before what has one, so that no two recordings look the same in a row.
    hash.add(view.channel->topic.size());
    hash.add(std::string_view(view.channel->topic));
    hash.add(view.message.log_time);
    hash.add(view.message.data.size);
    hash.add(view.message.data);
  }
}

}  // namespace swiftlet
