// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Swiftlet as a component sees it: with the mailbox and, where the variant says so, without it.
#include <thread>

#include "components/runtime/host.hpp"
#include "components/runtime/plain_types.hpp"
#include "sensor_msgs.h"
#include "tests/bench/middleware/peer.hpp"

namespace swiftlet::bench {
namespace {

using sensor_msgs::msg::Image;

QosProfile profile(const PeerOptions& options) {
  return options.large() ? qos::bulk : qos::state;
}

bool is_plain(const PeerOptions& options) {
  return options.variant.find("plain") != std::string::npos;
}

/// What a sender looks like to the harness, whichever type it sends.
class Sender : public Component {
 public:
  using Component::Component;
  virtual void publish(const Mark& mark) = 0;
  virtual int matched_readers() const = 0;
};

class ImageSender : public Sender {
 public:
  ImageSender(const ComponentContext& context, const PeerOptions& options)
      : Sender(context), publisher_(advertise(Topic<Image>{"bench", profile(options)})) {
    message_.encoding("mono8");
    message_.data().resize(options.bytes);
  }
  void publish(const Mark& mark) override {
    message_.header().stamp().sec(std::int32_t(mark.sent_ns / kSecond));
    message_.header().stamp().nanosec(std::uint32_t(mark.sent_ns % kSecond));
    message_.width(mark.number);
    publisher_.publish(message_);
  }
  int matched_readers() const override { return publisher_.matched_readers(); }

 private:
  Publisher<Image> publisher_;
  Image message_;
};

template <class Frame>
class FrameSender : public Sender {
 public:
  explicit FrameSender(const ComponentContext& context)
      : Sender(context), publisher_(advertise(Topic<Frame>{"bench", qos::bulk})) {}
  void publish(const Mark& mark) override {
    Loan<Frame> frame = publisher_.loan();
    frame->info().stamp().sec(std::int32_t(mark.sent_ns / kSecond));
    frame->info().stamp().nanosec(std::uint32_t(mark.sent_ns % kSecond));
    frame->info().width(mark.number);
    publisher_.publish(std::move(frame));
  }
  int matched_readers() const override { return publisher_.matched_readers(); }

 private:
  Publisher<Frame> publisher_;
};

class Receiver : public Component {
 public:
  Receiver(const ComponentContext& context, const PeerOptions& options) : Component(context) {
    if (!is_plain(options)) {
      subscribe(topic<Image>(options), [on_message = options.on_message](const Image& image) {
        const auto& stamp = image.header().stamp();
        on_message({stamp.sec() * kSecond + stamp.nanosec(), image.width()});
      });
    } else if (options.bytes <= 100'000) {
      subscribe_frames<swiftlet_frames::msg::Image640k>(options);
    } else {
      subscribe_frames<swiftlet_frames::msg::Image1M>(options);
    }
  }

 private:
  template <class T>
  static Topic<T> topic(const PeerOptions& options) {
    const Topic<T> result{"bench", is_plain(options) ? qos::bulk : profile(options)};
    return options.variant.find("at-once") == 0 ? at_once(result) : result;
  }

  template <class Frame>
  void subscribe_frames(const PeerOptions& options) {
    subscribe(topic<Frame>(options), [on_message = options.on_message](const Frame& frame) {
      const auto& stamp = frame.info().stamp();
      on_message({stamp.sec() * kSecond + stamp.nanosec(), frame.info().width()});
    });
  }
};

class SwiftletPeer : public Peer {
 public:
  explicit SwiftletPeer(const PeerOptions& options) : host_(HostOptions{}) {
    if (options.sends) sender_ = &make_sender(options);
    if (options.receives) host_.emplace<Receiver>("receiver", options);
    runner_ = std::thread([this] { host_.run(); });
  }
  ~SwiftletPeer() override {
    host_.executor().stop(0);
    runner_.join();
  }
  void publish(const Mark& mark) override { sender_->publish(mark); }
  bool matched() override { return sender_->matched_readers() > 0; }

 private:
  Sender& make_sender(const PeerOptions& options) {
    if (!is_plain(options)) return host_.emplace<ImageSender>("sender", options);
    using namespace swiftlet_frames::msg;
    if (options.bytes <= 100'000) return host_.emplace<FrameSender<Image640k>>("sender");
    return host_.emplace<FrameSender<Image1M>>("sender");
  }

  Host host_;
  Sender* sender_ = nullptr;
  std::thread runner_;
};

}  // namespace

const std::vector<std::string>& variants() {
  static const std::vector<std::string> all{"mailbox", "at-once", "mailbox-plain", "at-once-plain"};
  return all;
}

std::unique_ptr<Peer> make_peer(const PeerOptions& options) {
  if (is_plain(options) && options.bytes < 10'000) return nullptr;
  return std::make_unique<SwiftletPeer>(options);
}

}  // namespace swiftlet::bench
