// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/gated_transport.hpp"

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <algorithm>
#include <cstdlib>
#include <new>
#include <utility>

#include "components/runtime/dds/rtps_guard.hpp"
#include "components/runtime/log.hpp"

namespace swiftlet {

namespace transport = eprosima::fastdds::rtps;
namespace rtps = eprosima::fastrtps::rtps;

namespace {

struct GatedDescriptor : transport::ChainingTransportDescriptor {
  GatedDescriptor(std::shared_ptr<transport::TransportDescriptorInterface> low_level,
                  Gate gate_of_all)
      : ChainingTransportDescriptor(std::move(low_level)), gate(std::move(gate_of_all)) {}

  transport::TransportInterface* create_transport() const override;

  Gate gate;
};

constexpr std::size_t kLargestDatagram = 1 << 16;

/// A copy that RtpsGuard::kFragmentOverrun bytes follow, valid until the next call in this thread.
/// Those are not touched, so that they take no memory.
const rtps::octet* with_room_behind(const rtps::octet* buffer, std::uint32_t size) {
  struct Free {
    void operator()(rtps::octet* memory) const { std::free(memory); }
  };
  thread_local const std::unique_ptr<rtps::octet, Free> copy(
      static_cast<rtps::octet*>(std::calloc(1, kLargestDatagram + RtpsGuard::kFragmentOverrun)));
  if (copy == nullptr) throw std::bad_alloc();
  std::copy_n(buffer, std::min<std::size_t>(size, kLargestDatagram), copy.get());
  return copy.get();
}

class GatedTransport : public transport::ChainingTransport {
 public:
  explicit GatedTransport(const GatedDescriptor& descriptor)
      : ChainingTransport(descriptor), descriptor_(descriptor) {}

  transport::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

  bool send(rtps::SenderResource* sender, const rtps::octet* buffer, std::uint32_t size,
            rtps::LocatorsIterator* destinations_begin, rtps::LocatorsIterator* destinations_end,
            const std::chrono::steady_clock::time_point& timeout) override {
    // As if it were lost on the way: RTPS repeats what matters.
    if (!descriptor_.gate->load(std::memory_order_relaxed)) return true;
    return sender->send(buffer, size, destinations_begin, destinations_end, timeout);
  }

  void receive(transport::TransportReceiverInterface* next, const rtps::octet* buffer,
               std::uint32_t size, const rtps::Locator_t& local,
               const rtps::Locator_t& remote) override {
    const RtpsGuard::Verdict verdict = guard_.judge(buffer, size);
    if (verdict.problem != nullptr) return drop(verdict.problem, remote);
    if (verdict.has_fragments) buffer = with_room_behind(buffer, size);
    next->OnDataReceived(buffer, static_cast<std::uint32_t>(verdict.size), local, remote);
  }

 private:
  /// Called by several threads, one a port.
  void drop(const char* problem, const rtps::Locator_t& remote) {
    const std::uint64_t count = ++dropped_;
    if (!is_worth_a_line(count)) return;
    logger("network")->warn("a datagram from {} is dropped, the {}. so far: {}",
                            rtps::IPLocator::toIPv4string(remote), count, problem);
  }

  GatedDescriptor descriptor_;
  RtpsGuard guard_;
  std::atomic<std::uint64_t> dropped_{0};
};

transport::TransportInterface* GatedDescriptor::create_transport() const {
  return new GatedTransport(*this);  // owned by who asks
}

}  // namespace

std::shared_ptr<transport::TransportDescriptorInterface> gated(
    std::shared_ptr<transport::TransportDescriptorInterface> transport, Gate gate) {
  return std::make_shared<GatedDescriptor>(std::move(transport), std::move(gate));
}

}  // namespace swiftlet
