// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/phone_sim/phone_sim_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <random>

#include "components/conversions.hpp"
#include "components/phone_link/phone_params.hpp"
#include "components/phone_link/udp_socket.hpp"
#include "components/phone_sim/made_up_motion.hpp"
#include "components/phone_sim/phone_simulator.hpp"
#include "components/runtime/command_line.hpp"
#include "components/runtime/number_check.hpp"
#include "components/runtime/runtime_error.hpp"
#include "components/sim/scenario.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kMotionStep = 2ms;
constexpr Duration kMissTruthAfter = 3s;

struct PhoneSimOptions {
  std::string to = "127.0.0.1";
  std::uint16_t port = kPhonePort;
  bool follow = false;
  std::string trajectory = "circle";
  std::string scenario;
  double rate_hz = 0.0;
  bool json = false;
  std::uint64_t seed = 1;
  double duration = 0.0;
  double jitter_ms = 0.0;
  double latency_ms = 0.0;
  double drop = 0.0;
  double clock_offset = 0.0;
  double clock_drift_ppm = 0.0;
  double jump_at = -1.0;
  std::vector<double> jump{1.0, 0.0, 0.0, 0.0};
  NetworkOptions network;
};

/// Sends by UDP what the simulated phone says of the vehicle: the one of `swiftlet run sim`, or one
/// that is made up.
class PhoneSim : public Component {
 public:
  PhoneSim(const ComponentContext& context, const PhoneSimOptions& options,
           const PhoneSimulator::Params& params, const UdpEndpoint& to, UdpSocket socket)
      : Component(context),
        options_(options),
        simulator_(params, options.seed),
        jitter_(options.seed, "phone jitter"),
        to_(to),
        socket_(std::move(socket)) {
    if (options_.follow) {
      subscribe(topic::sim_truth, [this](const swiftlet_msgs::msg::SimTruth& truth) {
        VehicleTruth vehicle;
        vehicle.body.p_WB = from_msg(truth.pose().position());
        vehicle.body.q_WB = from_msg(truth.pose().orientation());
        move(from_msg(truth.header().stamp()), vehicle);
      });
      call_at(now() + kMissTruthAfter, [this](Time) {
        if (!begin_) log()->warn("nobody says where the vehicle is; is 'swiftlet run sim' there?");
      });
    } else {
      const auto motion =
          options_.trajectory == "hover" ? MadeUpMotion::kHover : MadeUpMotion::kCircle;
      every(kMotionStep, [this, motion](Time now) {
        move(now, made_up_truth(motion, Time(begin_ ? now - *begin_ : Duration(0))));
      });
    }
  }

  std::uint64_t sent() const { return sent_; }

 private:
  void move(Time time, VehicleTruth vehicle) {
    if (!begin_) begin_ = time;
    vehicle.time = Time(time - *begin_);
    if (options_.duration > 0.0 && to_seconds(vehicle.time) > options_.duration) return stop(0);
    auto datagram = simulator_.update(vehicle);
    if (!datagram) return;
    if (options_.jitter_ms <= 0.0) return send(*datagram);
    const double delay = -1e-3 * options_.jitter_ms * std::log(1.0 - jitter_.uniform());
    call_at(now() + from_seconds(delay),
            [this, bytes = std::move(*datagram)](Time) { send(bytes); });
  }

  void send(const DatagramBytes& bytes) {
    const Status status = socket_.send(bytes.data(), bytes.size(), to_);
    if (status.ok()) {
      ++sent_;
    } else if (is_worth_a_line(++failed_)) {
      log()->warn("{} ({} so far)", status.error().reason, failed_);
    }
  }

  PhoneSimOptions options_;
  PhoneSimulator simulator_;
  RandomStream jitter_;
  UdpEndpoint to_;
  UdpSocket socket_;
  std::optional<Time> begin_;
  std::uint64_t sent_ = 0;
  std::uint64_t failed_ = 0;
};

PhoneSimulator::Params simulator_params(const PhoneSimOptions& options) {
  PhoneSimulator::Params params;
  if (!options.scenario.empty()) params.sensor = Scenario::load(options.scenario).sensors.phone;
  if (options.rate_hz > 0.0) params.sensor.rate_hz = options.rate_hz;
  if (options.latency_ms > 0.0) params.sensor.latency_ms = options.latency_ms;
  if (options.drop > 0.0) params.sensor.drop_probability = options.drop;
  params.clock_offset = options.clock_offset;
  params.clock_drift = 1e-6 * options.clock_drift_ppm;
  params.json = options.json;
  if (options.jump_at >= 0.0) {
    params.jump = PhoneSimulator::Jump{
        options.jump_at, {options.jump[0], options.jump[1], options.jump[2]}, options.jump[3]};
  }
  // Not by the seed: a phone that is started again has another one.
  params.session = std::random_device()();
  return params;
}

void simulate_phone(const PhoneSimOptions& options) {
  const auto address = parse_address(options.to);
  if (!address) {
    throw ConfigError(
        fmt::format("--to {}: is no IPv4 address such as 192.168.42.129", options.to));
  }
  const UdpEndpoint to{*address, options.port};
  const PhoneSimulator::Params params = simulator_params(options);
  auto socket = UdpSocket::open();
  if (!socket) throw RuntimeError(socket.error().reason);
  Host host(options.network.host_options("phone_sim"));
  auto& phone = host.emplace<PhoneSim>("phone_sim", options, params, to, std::move(socket).value());
  logger("phone_sim")
      ->info("sends {} poses a second to {}, {}", params.sensor.rate_hz, to_string(to),
             options.follow ? "of the simulated vehicle" : "of a made-up " + options.trajectory);
  const int code = host.run();
  fmt::print("{} poses sent to {}\n", phone.sent(), to_string(to));
  if (code != 0) throw CLI::RuntimeError(code);
}

}  // namespace

void add_phone_sim(CLI::App& app) {
  auto options = std::make_shared<PhoneSimOptions>();
  CLI::App* verb = app.add_subcommand("phone-sim", "Send poses to phone_link as a phone would");
  verb->add_option("--to", options->to, "IPv4 address of the vehicle")->capture_default_str();
  verb->add_option("--port", options->port, "UDP port")
      ->check(whole_within(1, 65535))
      ->capture_default_str();
  verb->add_flag("--follow", options->follow,
                 "The vehicle of 'swiftlet run sim --param sim.phone=false'");
  verb->add_option("--trajectory", options->trajectory, "Without --follow: hover or circle")
      ->check(CLI::IsMember({"hover", "circle"}))
      ->capture_default_str();
  verb->add_option("--scenario", options->scenario,
                   "Take rate, errors and mount of the phone from its sensors.phone");
  verb->add_option("--rate", options->rate_hz, "Poses a second [30]")->check(within(0.1, 500.0));
  verb->add_flag("--json", options->json, "Send JSON with a checksum, not the binary form");
  verb->add_option("--seed", options->seed, "Decides the errors, and the frame of the phone")
      ->check(whole_within(0, UINT32_MAX))
      ->capture_default_str();
  verb->add_option("--duration", options->duration, "Seconds; until interrupted without")
      ->check(within(0.0, 1e6));
  verb->add_option("--latency", options->latency_ms, "Delay of each pose [ms]")
      ->check(within(0.0, 1e4));
  verb->add_option("--jitter", options->jitter_ms, "Mean of a random delay on top of it [ms]")
      ->check(within(0.0, 1e4));
  verb->add_option("--drop", options->drop, "Probability that a pose is lost")
      ->check(within(0.0, 1.0));
  verb->add_option("--clock-offset", options->clock_offset,
                   "What the phone's clock shows at the start [s]")
      ->check(within(0.0, 2e9));
  verb->add_option("--clock-drift", options->clock_drift_ppm, "By how much it is fast [ppm]")
      ->check(within(-1e4, 1e4));
  verb->add_option("--jump-at", options->jump_at, "Seconds after which the phone finds itself anew")
      ->check(within(0.0, 1e6));
  verb->add_option("--jump", options->jump, "By how much: x y z [m] and yaw [rad], in its frame")
      ->expected(4)
      ->check(within(-1e3, 1e3))
      ->capture_default_str();
  options->network.add_to(*verb);
  verb->callback([options] { simulate_phone(*options); });
}

}  // namespace swiftlet
