// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "estimation/basics/result.hpp"

namespace swiftlet {

/// A message as it travels: CDR with the four bytes of encapsulation before it.
using Cdr = std::vector<std::uint8_t>;

/// What the middleware needs to know of a message type that the IDL files declare.
class MessageType {
 public:
  virtual ~MessageType() = default;

  /// "sensor_msgs/msg/Imu", as people and recordings call it.
  const std::string& name() const { return name_; }
  /// "sensor_msgs::msg::dds_::Imu_", as it is called on the wire.
  const std::string& dds_name() const { return dds_name_; }

  /// Bytes of `message`, encapsulation included. `message` points to an object of the C++ type.
  virtual std::size_t serialized_size(const void* message) const = 0;
  /// Writes the message to `buffer` and returns the number of bytes used; 0 where `capacity` is
  /// too small.
  virtual std::size_t serialize(const void* message, std::uint8_t* buffer,
                                std::size_t capacity) const = 0;
  /// False, with `message` in an unspecified but valid state, where the bytes are not of this type.
  virtual bool deserialize(const std::uint8_t* bytes, std::size_t size, void* message) const = 0;
  /// Bytes of an object of a plain type, which looks in memory as it does in CDR, so that writers
  /// and readers may share it; 0 for all other types.
  virtual std::size_t plain_size() const = 0;

 protected:
  MessageType(const std::string& package, const std::string& name)
      : name_(package + "/msg/" + name), dds_name_(package + "::msg::dds_::" + name + "_") {}

 private:
  std::string name_;
  std::string dds_name_;
};

/// Whether T is a plain type: of fixed size and with the layout of CDR (runtime/plain_types.hpp).
template <class T>
struct IsPlain : std::false_type {};

/// The type with that C++ class, for every struct of the IDL files.
template <class T>
const MessageType& message_type();

/// The type with that name, in either spelling; null where the IDL files have none.
const MessageType* find_message_type(const std::string& name);

/// All types, in the order of the IDL files.
const std::vector<const MessageType*>& message_types();

/// "sensor_msgs/msg/Imu" of "sensor_msgs::msg::dds_::Imu_", for types that we do not know too.
std::string ros_type_name(const std::string& dds_name);
/// The inverse of ros_type_name.
std::string dds_type_name(const std::string& ros_name);

template <class T>
Cdr to_cdr(const T& message) {
  const MessageType& type = message_type<T>();
  Cdr cdr(type.serialized_size(&message));
  cdr.resize(type.serialize(&message, cdr.data(), cdr.size()));
  return cdr;
}

template <class T>
Result<T> from_cdr(const Cdr& cdr) {
  T message;
  const MessageType& type = message_type<T>();
  if (!type.deserialize(cdr.data(), cdr.size(), &message)) {
    return Error{std::to_string(cdr.size()) + " bytes are not a " + type.name()};
  }
  return message;
}

}  // namespace swiftlet
