// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/message.hpp"

#include <fastcdr/Cdr.h>
#include <fastcdr/exceptions/Exception.h>

#include <algorithm>
#include <exception>
#include <type_traits>
#include <utility>

#include "all_messages.hpp"
#include "components/runtime/plain_types.hpp"

namespace swiftlet {
namespace {

using CdrStream = eprosima::fastcdr::Cdr;

constexpr std::size_t kEncapsulation = 4;

/// Bytes of the long list of numbers that a frame, a cloud or a map has as its `data`. They follow
/// one another without padding.
template <class T, class = void>
struct Bulk {
  static std::size_t size(const T&) { return 0; }
};

template <class T>
using DataElement = typename std::decay_t<decltype(std::declval<const T&>().data())>::value_type;

template <class T>
struct Bulk<T, std::enable_if_t<std::is_arithmetic_v<DataElement<T>>>> {
  static std::size_t size(const T& message) {
    return message.data().size() * sizeof(DataElement<T>);
  }
};

/// CDR skips the bytes of padding, and the same message is to have the same bytes always. Of `size`
/// bytes `bulk` belong to one list, wherever it stands: padding is as near as the rest to one end
/// or to the other.
void zero_padding(std::uint8_t* buffer, std::size_t size, std::size_t bulk) {
  const std::size_t rest = size - bulk;
  if (2 * rest >= size) {
    std::fill_n(buffer, size, std::uint8_t{0});
  } else {
    std::fill_n(buffer, rest, std::uint8_t{0});
    std::fill_n(buffer + bulk, rest, std::uint8_t{0});
  }
}

template <class T>
class GeneratedType : public MessageType {
 public:
  GeneratedType(const std::string& package, const std::string& name) : MessageType(package, name) {}

  std::size_t serialized_size(const void* message) const override {
    return kEncapsulation + T::getCdrSerializedSize(*static_cast<const T*>(message));
  }

  std::size_t serialize(const void* message, std::uint8_t* buffer,
                        std::size_t capacity) const override {
    const std::size_t size = serialized_size(message);
    if (size > capacity) return 0;
    try {
      zero_padding(buffer, size, Bulk<T>::size(*static_cast<const T*>(message)));
      eprosima::fastcdr::FastBuffer bytes(reinterpret_cast<char*>(buffer), size);
      CdrStream cdr(bytes, CdrStream::LITTLE_ENDIANNESS, CdrStream::DDS_CDR);
      cdr.serialize_encapsulation();
      static_cast<const T*>(message)->serialize(cdr);
      return cdr.getSerializedDataLength();
    } catch (const eprosima::fastcdr::exception::Exception&) {
      return 0;
    }
  }

  bool deserialize(const std::uint8_t* bytes, std::size_t size, void* message) const override {
    if (read(bytes, size, *static_cast<T*>(message))) return true;
    // A sequence was given room for as many elements as there are bytes. Those who keep the object
    // for the next message must not keep that.
    if constexpr (!IsPlain<T>::value) *static_cast<T*>(message) = T();
    return false;
  }

  std::size_t plain_size() const override { return IsPlain<T>::value ? sizeof(T) : 0; }

 private:
  static bool read(const std::uint8_t* bytes, std::size_t size, T& message) {
    try {
      // fastcdr takes a writable buffer and only reads it.
      eprosima::fastcdr::FastBuffer buffer(const_cast<char*>(reinterpret_cast<const char*>(bytes)),
                                           size);
      CdrStream cdr(buffer, CdrStream::LITTLE_ENDIANNESS, CdrStream::DDS_CDR);
      cdr.read_encapsulation();
      message.deserialize(cdr);
      return true;
    } catch (const eprosima::fastcdr::exception::Exception&) {
      return false;  // too short, or a value that the type cannot have
    } catch (const std::exception&) {
      return false;  // a sequence longer than memory: the length is garbage
    }
  }
};

}  // namespace

#define SWIFTLET_MESSAGE(package, Name)                                   \
  template <>                                                             \
  const MessageType& message_type<package::msg::Name>() {                 \
    static const GeneratedType<package::msg::Name> type(#package, #Name); \
    return type;                                                          \
  }
#include "all_messages.inc"
#undef SWIFTLET_MESSAGE

const std::vector<const MessageType*>& message_types() {
  static const std::vector<const MessageType*> types{
#define SWIFTLET_MESSAGE(package, Name) &message_type<package::msg::Name>(),
#include "all_messages.inc"
#undef SWIFTLET_MESSAGE
  };
  return types;
}

const MessageType* find_message_type(const std::string& name) {
  for (const MessageType* type : message_types()) {
    if (type->name() == name || type->dds_name() == name) return type;
  }
  return nullptr;
}

std::string ros_type_name(const std::string& dds_name) {
  const std::string infix = "::dds_::";
  const std::size_t at = dds_name.find(infix);
  if (at == std::string::npos || dds_name.back() != '_') return dds_name;
  std::string name = dds_name.substr(0, at) + "::" +
                     dds_name.substr(at + infix.size(), dds_name.size() - at - infix.size() - 1);
  for (std::size_t i = name.find("::"); i != std::string::npos; i = name.find("::")) {
    name.replace(i, 2, "/");
  }
  return name;
}

std::string dds_type_name(const std::string& ros_name) {
  const std::size_t last = ros_name.rfind('/');
  if (last == std::string::npos) return ros_name;
  std::string name = ros_name.substr(0, last) + "/dds_/" + ros_name.substr(last + 1) + "_";
  for (std::size_t i = name.find('/'); i != std::string::npos; i = name.find('/')) {
    name.replace(i, 1, "::");
  }
  return name;
}

}  // namespace swiftlet
