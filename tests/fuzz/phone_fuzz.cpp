// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Datagrams at the port of phone_link: the input as one datagram, and as the fields of many sound
// ones.
#include <cmath>
#include <cstring>

#include "components/phone_link/phone_stream.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace swiftlet;

void decode_all(const std::uint8_t* data, std::size_t size) {
  for (const JsonPolicy json : {JsonPolicy::kRefused, JsonPolicy::kChecked, JsonPolicy::kAny}) {
    const auto pose = decode_pose(data, size, json);
    if (!pose.ok()) {
      fuzz::demand(!pose.error().reason.empty(), "a refusal has a reason");
      continue;
    }
    const DatagramBytes again = encode_binary(*pose);
    const auto same = decode_pose(again.data(), again.size(), JsonPolicy::kRefused);
    // A covariance that is barely positive definite may not be, once it is rounded.
    fuzz::demand(same.ok() || pose->covariance.has_value(), "what was taken is taken again");
    fuzz::demand(!same.ok() || encode_binary(*same) == again, "and is the same");
  }
}

/// Takes values off the input; zeros when it is used up.
class Fields {
 public:
  Fields(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  template <class T>
  T next() {
    T value{};
    const std::size_t count = sizeof(T) < size_ ? sizeof(T) : size_;
    std::memcpy(&value, data_, count);
    data_ += count;
    size_ -= count;
    return value;
  }
  bool done() const { return size_ == 0; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

/// Poses with whatever numbers, sealed by a sound checksum, from a few senders.
void fly(const std::uint8_t* data, std::size_t size) {
  Fields fields(data, size);
  PhoneStream stream(PhoneStream::Params{});
  Time arrival(std::chrono::seconds(1'700'000'000));
  Time last{};
  while (!fields.done()) {
    PhonePose pose;
    pose.session = fields.next<std::uint8_t>() % 3;
    pose.sequence = fields.next<std::uint32_t>();
    pose.time = Duration(fields.next<std::int64_t>());
    for (double& coordinate : pose.position) coordinate = fields.next<double>();
    pose.attitude.z() = fields.next<float>();
    if (pose.attitude.z() != 0.0) pose.attitude.normalize();
    arrival += Duration(fields.next<std::uint32_t>());
    const UdpEndpoint sender{0x7f000001, static_cast<std::uint16_t>(1 + pose.session)};
    const DatagramBytes bytes = encode_binary(pose);
    const auto received = stream.receive(bytes.data(), bytes.size(), sender, arrival);
    if (received.verdict != PhoneVerdict::kAccepted) continue;
    fuzz::demand(received.pose.p_WB.allFinite(), "the position is finite");
    fuzz::demand(received.pose.covariance.allFinite(), "the covariance is finite");
    fuzz::demand(std::abs(received.pose.q_WB.norm() - 1.0) < 1e-9, "the attitude is a rotation");
    // One nanosecond later each, where several arrive at once.
    fuzz::demand(received.time <= arrival + std::chrono::microseconds(10),
                 "no pose is from the future");
    fuzz::demand(received.time >= last, "poses come by time");
    last = received.time;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  decode_all(data, size);
  fly(data, size);
  return 0;
}
