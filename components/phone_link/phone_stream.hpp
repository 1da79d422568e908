// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "components/phone_link/pose_datagram.hpp"
#include "components/phone_link/sender_watch.hpp"
#include "estimation/clock/remote_clock.hpp"
#include "estimation/phone/frame_anchor.hpp"
#include "estimation/phone/jump_absorber.hpp"
#include "estimation/ukf/pose_imu_ukf.hpp"

namespace swiftlet {

/// What became of a datagram.
enum class PhoneVerdict {
  kAccepted,
  kCorrupt,      ///< it is no pose
  kForeign,      ///< of another sender than the phone
  kRepeated,     ///< it was here before
  kReordered,    ///< a later one was here before
  kLate,         ///< its pose is too old to be flown
  kImplausible,  ///< no motion leads there; an outlier, or the beginning of a jump
};
inline constexpr std::size_t kPhoneVerdicts = 7;
/// "accepted", "corrupt", ...
const char* to_string(PhoneVerdict verdict);

/// From datagrams to poses of the body in the map, on the vehicle's clock. It knows neither sockets
/// nor a clock of its own.
///
///     bytes ─ decode ─ SenderWatch ─ RemoteClock ─ FrameAnchor ─ JumpAbsorber ─> pose
///             corrupt  foreign,      late                        implausible
///                      repeated, reordered
///
/// What is not accepted changes nothing that is flown; late poses still tell of the clock.
class PhoneStream {
 public:
  using Covariance = Eigen::Matrix<double, 6, 6>;
  struct Params {
    JsonPolicy json = JsonPolicy::kRefused;
    SenderWatch::Params sender;
    RemoteClock::Params clock;
    double max_age = 0.2;  ///< of a pose that is flown, by the estimated clock [s]
    FrameAnchor::Params frame;
    /// Poses whose mean fixes the frame, the first of them alone at first. More than one where the
    /// vehicle is sure to stand still meanwhile.
    int start_poses = 1;
    JumpAbsorber::Params jump;
    /// Of the camera in the phone's frame, where a datagram has none: the Tango phone's errors,
    /// Table 2 of seed 000 (see PhonePoseSensor).
    Covariance covariance = tango_covariance();
  };
  struct Received {
    PhoneVerdict verdict = PhoneVerdict::kCorrupt;
    std::string reason;      ///< why it was not accepted
    PhonePose datagram;      ///< unless it is corrupt
    Time time{};             ///< of the pose, on the vehicle's clock; where it was accepted
    PoseMeasurement pose;    ///< of the body in the map; where it was accepted
    bool new_phone = false;  ///< the first pose, or one of a phone that was started again
    bool clock_restarted = false;
    std::optional<JumpAbsorber::Jump> jump;
  };

  explicit PhoneStream(const Params& params);

  Received receive(const std::uint8_t* bytes, std::size_t size, const UdpEndpoint& sender,
                   Time arrival);

  std::uint64_t count(PhoneVerdict verdict) const {
    return counts_[static_cast<std::size_t>(verdict)];
  }
  const std::optional<UdpEndpoint>& phone() const { return sender_.phone(); }
  const RemoteClock& clock() const { return clock_; }
  /// How far the output still is from where the phone says.
  const JumpAbsorber& jumps() const { return jumps_; }

  static Covariance tango_covariance();

 private:
  PhoneVerdict judge(Received& received, const std::uint8_t* bytes, std::size_t size,
                     const UdpEndpoint& sender, Time arrival);
  PhoneVerdict judge_sender(Received& received, const UdpEndpoint& sender, Time arrival);
  PhoneVerdict place_in_map(Received& received);
  void begin(const FrameAnchor::Pose& camera);
  void fix_frame(const FrameAnchor::Pose& camera);
  JumpAbsorber::Output follow(const FrameAnchor::Pose& camera, const Covariance& covariance,
                              Time time);

  Params params_;
  SenderWatch sender_;
  RemoteClock clock_;
  FrameAnchor anchor_;
  JumpAbsorber jumps_;
  bool begins_ = false;                      // the next pose in time is the first of a phone
  int to_refine_ = 0;                        // poses that the frame is still refined by
  std::optional<FrameAnchor::Pose> resume_;  // where the body was when its phone was started again
  std::array<std::uint64_t, kPhoneVerdicts> counts_{};
};

}  // namespace swiftlet
