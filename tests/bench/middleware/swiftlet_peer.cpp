// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Swiftlet as a component sees it: with the mailbox and, where the variant says so, without it.
#include <thread>

#include "components/runtime/host.hpp"
#include "sensor_msgs.h"
#include "tests/bench/middleware/peer.hpp"

namespace swiftlet::bench {
namespace {

using sensor_msgs::msg::Image;

QosProfile profile(const PeerOptions& options) {
  return options.large() ? qos::bulk : qos::state;
}

struct ImageSender : Component {
  ImageSender(const ComponentContext& context, const PeerOptions& options)
      : Component(context),
        publisher(advertise(Topic<Image>{"bench", profile(options)})) {
    message.encoding("mono8");
    message.data().resize(options.bytes);
  }
  void publish(const Mark& mark) {
    message.header().stamp().sec(std::int32_t(mark.sent_ns / kSecond));
    message.header().stamp().nanosec(std::uint32_t(mark.sent_ns % kSecond));
    message.width(mark.number);
    publisher.publish(message);
  }
  Publisher<Image> publisher;
  Image message;
};

struct ImageReceiver : Component {
  ImageReceiver(const ComponentContext& context, const PeerOptions& options) : Component(context) {
    subscribe(Topic<Image>{"bench", profile(options)},
              [on_message = options.on_message](const Image& image) {
                const auto& stamp = image.header().stamp();
                on_message({stamp.sec() * kSecond + stamp.nanosec(), image.width()});
              });
  }
};

class SwiftletPeer : public Peer {
 public:
  explicit SwiftletPeer(const PeerOptions& options) : host_(HostOptions{}) {
    if (options.sends) sender_ = &host_.emplace<ImageSender>("sender", options);
    if (options.receives) host_.emplace<ImageReceiver>("receiver", options);
    runner_ = std::thread([this] { host_.run(); });
  }
  ~SwiftletPeer() override {
    host_.executor().stop(0);
    runner_.join();
  }
  void publish(const Mark& mark) override { sender_->publish(mark); }
  bool matched() override { return sender_->publisher.matched_readers() > 0; }

 private:
  Host host_;
  ImageSender* sender_ = nullptr;
  std::thread runner_;
};

}  // namespace

const std::vector<std::string>& variants() {
  static const std::vector<std::string> all{"mailbox"};
  return all;
}

std::unique_ptr<Peer> make_peer(const PeerOptions& options) {
  return std::make_unique<SwiftletPeer>(options);
}

}  // namespace swiftlet::bench
