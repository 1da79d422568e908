// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <string>

#include "components/conversions.hpp"
#include "components/joystick/joystick_axes.hpp"
#include "components/manual_control_message.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kPeriod = 50ms;
constexpr Duration kRetry = 1s;
constexpr int kEventsAtOnce = 64;

JoystickAxes::Params read_params(const Config& config) {
  JoystickAxes::Params params;
  constexpr struct {
    const char* key;
    int JoystickAxes::Params::*code;
    int highest;
  } kCodes[] = {{"forward_axis", &JoystickAxes::Params::forward, ABS_MAX},
                {"left_axis", &JoystickAxes::Params::left, ABS_MAX},
                {"up_axis", &JoystickAxes::Params::up, ABS_MAX},
                {"turn_axis", &JoystickAxes::Params::turn, ABS_MAX},
                {"assist_button", &JoystickAxes::Params::assist, KEY_MAX}};
  for (const auto& [key, code, highest] : kCodes) {
    config.read(key, params.*code, {0.0, static_cast<double>(highest)});
  }
  return params;
}

/// A joystick or gamepad as a remote control. While it is not there, nothing is said: a vehicle
/// that is steered hovers then.
class Joystick : public Component {
 public:
  explicit Joystick(const ComponentContext& context)
      : Component(context), axes_(read_params(parameters())) {
    parameters().require("device", device_);
    manual_control_ = advertise(topic::manual_control);
    every(kPeriod, [this](Time now) { advance(now); });
  }
  ~Joystick() override { close(); }

 private:
  void advance(Time now) {
    if (file_ < 0 && now >= next_try_) open(now);
    if (file_ < 0 || !read_events()) return;
    manual_control_.publish(to_msg(axes_.sticks(), now, ""));
  }

  void open(Time now) {
    next_try_ = now + kRetry;
    file_ = ::open(device_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file_ < 0) {
      const std::string problem =
          fmt::format("{} cannot be opened: {}", device_, std::strerror(errno));
      if (problem != problem_) log()->warn("{}; tried again every second", problem);
      problem_ = problem;
      return;
    }
    problem_.clear();
    log()->info("reads {}", device_);
    for (int code = 0; code <= ABS_MAX; ++code) {
      input_absinfo info{};
      if (ioctl(file_, EVIOCGABS(code), &info) < 0) continue;
      axes_.set_range(code, info.minimum, info.maximum);
      input_event now_at{};
      now_at.type = EV_ABS;
      now_at.code = static_cast<std::uint16_t>(code);
      now_at.value = info.value;
      axes_.hear(now_at);
    }
  }

  /// False where the device is gone.
  bool read_events() {
    input_event events[kEventsAtOnce];
    for (;;) {
      const ssize_t size = ::read(file_, events, sizeof(events));
      const bool nothing = size < 0 && (errno == EAGAIN || errno == EINTR);
      if (nothing) return true;
      if (size <= 0) break;
      const auto count = static_cast<std::size_t>(size) / sizeof(input_event);
      for (std::size_t i = 0; i < count; ++i) axes_.hear(events[i]);
    }
    problem_ = fmt::format("{} is gone", device_);
    log()->warn("{}", problem_);
    close();
    return false;
  }

  void close() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
  }

  std::string obstacle() const override { return problem_; }

  JoystickAxes axes_;
  std::string device_;
  int file_ = -1;
  Time next_try_{};
  std::string problem_;
  Publisher<swiftlet_msgs::msg::ManualControl> manual_control_;
};

const RegisterComponent<Joystick> kRegistered{"joystick", "a joystick or gamepad steers (evdev)"};

}  // namespace
}  // namespace swiftlet
