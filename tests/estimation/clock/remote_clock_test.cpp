// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// A phone's clock that drifts, and a network that delays.
#include "estimation/clock/remote_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

struct Link {
  double drift = 50e-6;     // the phone's seconds are longer by that
  double shortest = 0.002;  // delay [s]
  double jitter = 0.005;    // mean of the exponential delay on top [s]
  double outliers = 0.0;    // probability of another 200 ms
  double rate_hz = 30.0;
};

/// Sends stamps and measures by how much the estimate of their time is wrong.
class Simulation {
 public:
  explicit Simulation(const Link& link, const RemoteClock::Params& params = {}, unsigned seed = 1)
      : link_(link), clock_(params), random_(seed) {}

  /// Runs for `seconds`; the worst error [s] of all stamps from `settle` seconds on.
  double run(double seconds, double settle) {
    double worst = 0.0;
    const Time end = now_ + from_seconds(seconds);
    const Time judged = now_ + from_seconds(settle);
    while (now_ < end) {
      now_ += from_seconds(1.0 / link_.rate_hz);
      double delay = link_.shortest - link_.jitter * std::log(1.0 - uniform_(random_));
      if (uniform_(random_) < link_.outliers) delay += 0.2;
      arrival_ = std::max(arrival_, now_ + from_seconds(delay));
      const auto reading = clock_.observe(phone_time(now_), arrival_);
      EXPECT_GT(reading.time, last_) << "time runs backwards";
      EXPECT_LE(reading.time, arrival_) << "a stamp from the future";
      EXPECT_EQ(reading.age, arrival_ - reading.time);
      last_ = reading.time;
      restarts_ += reading.restarted;
      if (now_ >= judged) worst = std::max(worst, std::abs(to_seconds(reading.time - now_)));
    }
    return worst;
  }

  /// The phone's clock jumps by that [s].
  void set_clock(double by) { offset_ += from_seconds(by); }
  void pause(Duration length) { now_ += length; }
  Link& link() { return link_; }
  const RemoteClock& clock() const { return clock_; }
  int restarts() const { return restarts_; }
  Duration true_offset() const { return now_.time_since_epoch() - phone_time(now_); }

 private:
  Duration phone_time(Time time) const {
    return offset_ + from_seconds((1.0 - link_.drift) * to_seconds(time - kBegin));
  }

  // As a vehicle's clock since 1970 and a phone's since it was switched on have it.
  static constexpr Time kBegin{1'700'000'000s};
  Link link_;
  RemoteClock clock_;
  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
  Time now_ = kBegin;
  Time arrival_{};
  Time last_{};
  Duration offset_ = 5000s;
  int restarts_ = 0;
};

RemoteClock::Params knowing(double latency) {
  RemoteClock::Params params;
  params.assumed_latency = latency;
  return params;
}

TEST(RemoteClock, IsWithinAMillisecondAfterFiveSeconds) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Simulation simulation({}, knowing(0.002), seed);
    EXPECT_LT(simulation.run(120.0, 5.0), 1e-3) << seed;
    EXPECT_EQ(simulation.restarts(), 0);
  }
}

TEST(RemoteClock, FindsTheDrift) {
  for (const double drift : {-150e-6, 0.0, 50e-6, 150e-6}) {
    Link link;
    link.drift = drift;
    Simulation simulation(link, knowing(0.002));
    EXPECT_LT(simulation.run(90.0, 30.0), 1e-3);
    EXPECT_NEAR(simulation.clock().skew(), drift, 10e-6);
    EXPECT_NEAR(to_seconds(simulation.clock().offset() - simulation.true_offset()), 0.0, 1e-3);
  }
}

TEST(RemoteClock, WhatIsLateTellsNothing) {
  Link link;
  link.outliers = 0.05;
  Simulation simulation(link, knowing(0.002));
  EXPECT_LT(simulation.run(120.0, 10.0), 1.5e-3);
  EXPECT_EQ(simulation.restarts(), 0);
}

TEST(RemoteClock, IsOffByWhatTheAssumedLatencyIsOffBy) {
  Link link;
  link.jitter = 1e-6;
  link.shortest = 0.020;
  Simulation simulation(link, knowing(0.005));
  EXPECT_NEAR(simulation.run(10.0, 5.0), 0.015, 1e-3);
}

TEST(RemoteClock, FollowsAClockThatWasSetAhead) {
  Simulation simulation({}, knowing(0.002));
  simulation.run(40.0, 40.0);
  simulation.set_clock(0.4);
  EXPECT_LT(simulation.run(60.0, 5.0), 1e-3);
  EXPECT_EQ(simulation.restarts(), 1);
}

TEST(RemoteClock, FollowsAClockThatWasSetBack) {
  Simulation simulation({}, knowing(0.002));
  simulation.run(40.0, 40.0);
  simulation.set_clock(-3600.0);
  EXPECT_LT(simulation.run(60.0, 5.0), 1e-3);
  EXPECT_EQ(simulation.restarts(), 1);
}

TEST(RemoteClock, FollowsAClockThatStoodStillWhileThePhoneSlept) {
  Simulation simulation({}, knowing(0.002));
  simulation.run(40.0, 40.0);
  simulation.pause(20s);
  simulation.set_clock(-20.0);
  simulation.run(4.5, 6.0);
  EXPECT_EQ(simulation.restarts(), 0) << "it might be a delay";
  EXPECT_LT(simulation.run(60.0, 5.0), 1e-3);
  EXPECT_EQ(simulation.restarts(), 1);
}

TEST(RemoteClock, ACongestedNetworkIsNoClockThatWasSet) {
  Simulation simulation({}, knowing(0.002));
  simulation.run(30.0, 30.0);
  simulation.link().shortest = 0.4;
  simulation.run(4.0, 4.0);
  EXPECT_EQ(simulation.restarts(), 0);
  simulation.link().shortest = 0.002;
  EXPECT_LT(simulation.run(30.0, 1.0), 1e-3);
  EXPECT_EQ(simulation.restarts(), 0);
}

TEST(RemoteClock, AStampThatWaitedIsOldWhenItArrives) {
  RemoteClock clock;
  Time now(100s);
  for (int i = 0; i < 100; ++i) {
    now += 33ms;
    clock.observe(now.time_since_epoch() + 7s, now);
  }
  now += 33ms;
  const auto reading = clock.observe(now.time_since_epoch() + 7s, now + 150ms);
  EXPECT_NEAR(to_seconds(reading.age), 0.150, 1e-4);
  EXPECT_NEAR(to_seconds(reading.time - now), 0.0, 1e-4);
}

}  // namespace
}  // namespace swiftlet
