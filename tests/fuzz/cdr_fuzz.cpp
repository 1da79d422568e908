// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The first byte chooses a message type, the rest is a payload from the wire. It goes the way of a
// subscription (an object that is kept, filled by the generated class) and that of introspection
// (decoding by description); both must be of one opinion.
#include <algorithm>
#include <memory>

#include "all_messages.hpp"
#include "components/runtime/message.hpp"
#include "components/runtime/reflection/cdr_decoder.hpp"
#include "components/runtime/reflection/value_text.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace swiftlet;

/// An element of a sequence has at most so many bytes in memory for each that it has on the wire.
constexpr std::size_t kMostPerByte = 400;
constexpr std::size_t kMostBesides = 1 << 16;

struct Kind {
  const MessageType* type;
  std::shared_ptr<void> object;
};

template <class T>
Kind kind_of() {
  return {&message_type<T>(), std::make_shared<T>()};
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> kinds{
#define SWIFTLET_MESSAGE(package, Name) kind_of<package::msg::Name>(),
#include "all_messages.inc"
#undef SWIFTLET_MESSAGE
  };
  return kinds;
}

/// Plain CDR is all that both are promised to read.
bool is_plain_cdr(const Cdr& cdr) {
  return cdr.size() >= 4 && cdr[0] == 0 && cdr[1] <= 1;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Kind& kind = kinds()[data[0] % kinds().size()];
  static const TypeLibrary& library = TypeLibrary::built_in();
  const TypeDescription& description = *library.find(kind.type->name());
  const Cdr cdr(data + 1, data + size);

  const std::size_t before = fuzz::allocated();
  const bool taken = kind.type->deserialize(cdr.data(), cdr.size(), kind.object.get());
  const std::size_t by_class = fuzz::allocated() - before;
  const Result<Value> value = decode(description, cdr);
  const std::size_t by_description = fuzz::allocated() - before - by_class;
  fuzz::demand(by_class <= kMostPerByte * cdr.size() + kMostBesides,
               "memory of the class is in proportion", kind.type->name());
  fuzz::demand(by_description <= kMostPerByte * cdr.size() + kMostBesides,
               "memory of the decoder is in proportion", kind.type->name());

  if (is_plain_cdr(cdr)) {
    const bool has_rest =
        !value.ok() && value.error().reason.find("follow behind") != std::string::npos;
    fuzz::demand(taken == (value.ok() || has_rest), "both take it or refuse it",
                 value.ok() ? kind.type->name() : value.error().reason);
  }
  if (value.ok()) fuzz::demand(!to_yaml(*value).empty(), "it can be printed");
  if (taken) {
    Cdr again(kind.type->serialized_size(kind.object.get()));
    again.resize(kind.type->serialize(kind.object.get(), again.data(), again.size()));
    fuzz::demand(decode(description, again).ok(), "what was taken can be sent on",
                 kind.type->name());
  }
  return 0;
}
