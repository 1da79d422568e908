// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// A process that publishes at a known rate, for tests that record it.
//
//   bag_load DOMAIN TOPICS BYTES HZ SECONDS best_effort|reliable
//
// waits until each of its topics load_0, load_1, ... has a reader, publishes samples of BYTES at HZ
// in sum, and prints how many. The first eight bytes behind the encapsulation number them.
#include <cstdio>
#include <cstring>
#include <optional>
#include <random>
#include <string>

#include "components/runtime/component.hpp"
#include "components/runtime/host.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

struct Load {
  std::size_t topics = 1;
  std::size_t bytes = 0;
  double rate_hz = 0.0;
  double duration_s = 0.0;
  bool reliable = false;
};

class Speaker : public Component {
 public:
  Speaker(const ComponentContext& context, const Load& load) : Component(context), load_(load) {
    QosProfile qos = load.reliable ? qos::event : qos::sensor;
    qos.large = load.bytes > 60'000;
    for (std::size_t i = 0; i < load.topics; ++i) {
      writers_.push_back(
          advertise_raw("rt/load_" + std::to_string(i), "test::msg::dds_::Blob_", qos));
    }
    std::mt19937 random(1);
    sample_ = {0, 1, 0, 0};
    sample_.resize(load.bytes);
    // Like a picture: half noise.
    for (std::size_t i = 4; i < sample_.size(); ++i) {
      sample_[i] = static_cast<std::uint8_t>(i / 64 % 2 == 0 ? random() : i / 256);
    }
    every(1ms, [this](Time now) { speak(now); });
  }
  std::uint64_t spoken() const { return spoken_; }

 private:
  bool all_are_heard() const {
    for (const auto& writer : writers_) {
      if (writer->matched_readers() == 0) return false;
    }
    return true;
  }

  void speak(Time now) {
    if (!begin_) {
      if (!all_are_heard()) return;
      begin_ = now + 300ms;  // readers in other processes are ready a little later
    }
    const double due = load_.rate_hz * to_seconds(now - *begin_);
    const double all = load_.rate_hz * load_.duration_s;
    while (static_cast<double>(spoken_) < std::min(due, all)) {
      std::memcpy(sample_.data() + 4, &spoken_, sizeof(spoken_));
      writers_[spoken_ % writers_.size()]->write(sample_);
      ++spoken_;
    }
    if (static_cast<double>(spoken_) < all || ended_) return;
    ended_ = true;
    call_at(now + 2s, [this](Time) { stop(0); });  // for what must be sent again
  }

  Load load_;
  std::vector<std::shared_ptr<Writer>> writers_;
  Cdr sample_;
  std::optional<Time> begin_;
  std::uint64_t spoken_ = 0;
  bool ended_ = false;
};

}  // namespace
}  // namespace swiftlet

int main(int argc, char** argv) {
  if (argc != 7) return 2;
  swiftlet::HostOptions options;
  options.participant.domain = std::stoi(argv[1]);
  options.participant.name = "bag_load";
  swiftlet::Load load;
  load.topics = std::stoul(argv[2]);
  load.bytes = std::stoul(argv[3]);
  load.rate_hz = std::stod(argv[4]);
  load.duration_s = std::stod(argv[5]);
  load.reliable = std::string(argv[6]) == "reliable";
  swiftlet::Host host(options);
  const auto& speaker = host.emplace<swiftlet::Speaker>("load", load);
  const int exit_code = host.run();
  std::printf("%llu\n", static_cast<unsigned long long>(speaker.spoken()));
  return exit_code;
}
