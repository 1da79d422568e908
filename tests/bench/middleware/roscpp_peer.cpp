// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// ROS 1's C++ client: TCP without delay between processes, shared pointers within one.
#include <ros/ros.h>
#include <sensor_msgs/Image.h>

#include "tests/bench/middleware/peer.hpp"

namespace swiftlet::bench {
namespace {

class RoscppPeer : public Peer {
 public:
  explicit RoscppPeer(const PeerOptions& options) : options_(options) {
    ros::VP_string no_remapping;
    ros::init(no_remapping, options.sends ? "sender" : "receiver",
              ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
    node_ = std::make_unique<ros::NodeHandle>();
    const auto depth = static_cast<std::uint32_t>(options.depth());
    if (options.sends) {
      publisher_ = node_->advertise<sensor_msgs::Image>("bench", depth);
      message_.reset(new sensor_msgs::Image);
      message_->encoding = "mono8";
      message_->data.resize(options.bytes);
    }
    if (options.receives) {
      subscriber_ = node_->subscribe<sensor_msgs::Image>(
          "bench", depth,
          [this](const sensor_msgs::Image::ConstPtr& image) {
            options_.on_message(
                {image->header.stamp.sec * kSecond + image->header.stamp.nsec, image->width});
          },
          ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
      spinner_ = std::make_unique<ros::AsyncSpinner>(1);
      spinner_->start();
    }
  }

  void publish(const Mark& mark) override {
    // Within one process the receiver gets this very object, and is done with it in a millisecond.
    message_->header.stamp.sec = std::uint32_t(mark.sent_ns / kSecond);
    message_->header.stamp.nsec = std::uint32_t(mark.sent_ns % kSecond);
    message_->width = mark.number;
    publisher_.publish(message_);
  }

  bool matched() override { return publisher_.getNumSubscribers() > 0; }

 private:
  PeerOptions options_;
  std::unique_ptr<ros::NodeHandle> node_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  std::unique_ptr<ros::AsyncSpinner> spinner_;
  sensor_msgs::Image::Ptr message_;
};

}  // namespace

const std::vector<std::string>& variants() {
  static const std::vector<std::string> all{"callback"};
  return all;
}

std::unique_ptr<Peer> make_peer(const PeerOptions& options) {
  return std::make_unique<RoscppPeer>(options);
}

}  // namespace swiftlet::bench
