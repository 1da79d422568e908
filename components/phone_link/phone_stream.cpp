// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/phone_link/phone_stream.hpp"

#include <fmt/format.h>

#include <cmath>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {

const char* to_string(PhoneVerdict verdict) {
  switch (verdict) {
    case PhoneVerdict::kAccepted:
      return "accepted";
    case PhoneVerdict::kCorrupt:
      return "corrupt";
    case PhoneVerdict::kForeign:
      return "foreign";
    case PhoneVerdict::kRepeated:
      return "repeated";
    case PhoneVerdict::kReordered:
      return "reordered";
    case PhoneVerdict::kLate:
      return "late";
    case PhoneVerdict::kImplausible:
      return "implausible";
  }
  return "";
}

PhoneStream::Covariance PhoneStream::tango_covariance() {
  Eigen::Matrix<double, 6, 1> stddev;
  stddev << 0.0165, 0.0320, 0.0274, 0.02, 0.02, 0.2727;  // [m], then [rad]
  return stddev.cwiseAbs2().asDiagonal();
}

PhoneStream::PhoneStream(const Params& params)
    : params_(params),
      sender_(params.sender),
      clock_(params.clock),
      anchor_(params.frame),
      jumps_(params.jump) {}

PhoneStream::Received PhoneStream::receive(const std::uint8_t* bytes, std::size_t size,
                                           const UdpEndpoint& sender, Time arrival) {
  Received received;
  received.verdict = judge(received, bytes, size, sender, arrival);
  ++counts_[static_cast<std::size_t>(received.verdict)];
  return received;
}

PhoneVerdict PhoneStream::judge(Received& received, const std::uint8_t* bytes, std::size_t size,
                                const UdpEndpoint& sender, Time arrival) {
  auto decoded = decode_pose(bytes, size, params_.json);
  if (!decoded) {
    received.reason = decoded.error().reason;
    return PhoneVerdict::kCorrupt;
  }
  received.datagram = std::move(decoded).value();
  const PhoneVerdict order = judge_sender(received, sender, arrival);
  if (order != PhoneVerdict::kAccepted) return order;

  const RemoteClock::Reading reading = clock_.observe(received.datagram.time, arrival);
  received.time = reading.time;
  received.clock_restarted = reading.restarted;
  if (to_seconds(reading.age) > params_.max_age) {
    received.reason = fmt::format("its pose is {:.3f} s old", to_seconds(reading.age));
    return PhoneVerdict::kLate;
  }
  return place_in_map(received);
}

PhoneVerdict PhoneStream::judge_sender(Received& received, const UdpEndpoint& sender,
                                       Time arrival) {
  const PhonePose& datagram = received.datagram;
  switch (sender_.judge(sender, datagram.session, datagram.sequence, arrival)) {
    case SenderWatch::Verdict::kForeign:
      received.reason = fmt::format("session {:08x}; {}", datagram.session,
                                    sender_.phone() ? "the phone is " + to_string(*sender_.phone())
                                                    : "it is not the parameter 'sender'");
      return PhoneVerdict::kForeign;
    case SenderWatch::Verdict::kRepeated:
      received.reason = fmt::format("number {} came before", datagram.sequence);
      return PhoneVerdict::kRepeated;
    case SenderWatch::Verdict::kReordered:
      received.reason = fmt::format("number {} comes after a later one", datagram.sequence);
      return PhoneVerdict::kReordered;
    case SenderWatch::Verdict::kNewPhone:
      clock_ = RemoteClock(params_.clock);
      begins_ = true;
      return PhoneVerdict::kAccepted;
    case SenderWatch::Verdict::kNew:
      return PhoneVerdict::kAccepted;
  }
  return PhoneVerdict::kForeign;
}

PhoneVerdict PhoneStream::place_in_map(Received& received) {
  const PhonePose& datagram = received.datagram;
  const FrameAnchor::Pose camera{datagram.position, datagram.attitude.normalized()};
  const Covariance& covariance = datagram.covariance ? *datagram.covariance : params_.covariance;
  received.new_phone = begins_;
  if (begins_) begin(camera);
  const JumpAbsorber::Output output = follow(camera, covariance, received.time);
  if (output.outcome == JumpAbsorber::Outcome::kWithheld) {
    received.reason = "no motion of a vehicle leads there";
    return PhoneVerdict::kImplausible;
  }
  if (output.outcome == JumpAbsorber::Outcome::kJumped) received.jump = output.jump;
  received.pose.p_WB = output.pose.position;
  received.pose.q_WB = output.pose.attitude;
  received.pose.covariance = anchor_.body_covariance(camera, covariance);
  if (to_refine_ > 0 && !received.new_phone) {
    anchor_.refine(camera);
    --to_refine_;
  }
  return PhoneVerdict::kAccepted;
}

/// The map stays where it is. A phone that was started again has a new frame, and the best guess of
/// where the body is then is where it was.
void PhoneStream::begin(const FrameAnchor::Pose& camera) {
  begins_ = false;
  if (jumps_.last_output()) resume_ = jumps_.last_output();
  fix_frame(camera);
}

void PhoneStream::fix_frame(const FrameAnchor::Pose& camera) {
  to_refine_ = 0;
  if (resume_) {
    anchor_.fix(camera, resume_->position, yaw_of(resume_->attitude));
  } else {
    anchor_.fix(camera);
    to_refine_ = params_.start_poses - 1;
  }
  jumps_ = JumpAbsorber(params_.jump);
}

JumpAbsorber::Output PhoneStream::follow(const FrameAnchor::Pose& camera,
                                         const Covariance& covariance, Time time) {
  JumpAbsorber::Measurement measurement;
  measurement.time = time;
  measurement.position_sigma = std::sqrt(covariance.topLeftCorner<3, 3>().trace());
  measurement.attitude_sigma = std::sqrt(covariance.bottomRightCorner<3, 3>().trace());
  measurement.pose = anchor_.body_in_map(camera);
  JumpAbsorber::Output output = jumps_.follow(measurement);
  if (output.outcome != JumpAbsorber::Outcome::kFalseStart) return output;
  // The poses that the frame was fixed by were wild ones: it is fixed anew, to the same place.
  fix_frame(camera);
  measurement.pose = anchor_.body_in_map(camera);
  return jumps_.follow(measurement);
}

}  // namespace swiftlet
