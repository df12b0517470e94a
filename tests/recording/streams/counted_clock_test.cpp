// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/counted_clock.h"

#include "kinalign/protocols/sequence_count.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

LearnedDevice counted_clock(const std::vector<CountedFrame>& frames, double stated_step_ns) {
  DeviceRequest request;
  request.file.path = "take.mcap";
  LearnedDevice learned;
  count_clock(frames, stated_step_ns, request, learned);
  return learned;
}

/// A source of 125 frames a second, each of which takes a millisecond and more. For a while it
/// sends and counts nothing.
struct Source {
  std::vector<CountedFrame> frames;
  std::vector<HostTime> sent;

  explicit Source(Duration pause) {
    std::mt19937_64 random(20261123);
    std::exponential_distribution<double> more(1.0 / 0.002);
    HostTime newest{};
    for (std::int64_t k = 0; k < 7500; ++k) {
      const HostTime at{k * 8ms + (k >= 3000 ? pause : 0s)};
      newest = std::max(newest, at + 1ms + Duration{std::llround(1e9 * more(random))});
      frames.push_back({1, k, newest});
      sent.push_back(at);
    }
  }

  /// The largest error of a stamp.
  Duration worst(const LearnedDevice& counted) const {
    Duration worst{0};
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const NodeTime n = counter_of(frames[i], counted.step_ns);
      const auto stamp = stamp_of(counted.clock, frames[i].life, n, frames[i].arrival);
      REQUIRE(stamp);
      const Duration at = take_time(counted.clock.time, *stamp).time_since_epoch();
      worst = std::max(worst, std::chrono::abs(at - sent[i].time_since_epoch()));
    }
    return worst;
  }
};

}  // namespace

TEST_CASE("a pause in which a source did not count bends no rate, whatever is stated") {
  for (const Duration pause : {Duration{0}, Duration{70ms}, Duration{700ms}, Duration{1300ms},
                               Duration{5s}, Duration{10s}, Duration{600s}}) {
    CAPTURE(pause.count());
    const Source source(pause);
    for (const double stated_ns : {0.0, 8e6}) {
      const LearnedDevice counted = counted_clock(source.frames, stated_ns);
      CHECK(counted.findings.empty());
      CHECK(counted.step_ns == doctest::Approx(8e6).epsilon(0.002));
      CHECK(source.worst(counted) < 2500us);
    }
  }
}

TEST_CASE("a single wrong number shifts no other frame, also if the source restarts later") {
  for (const std::uint64_t wrong : {1'250ULL, 5'000'000ULL}) {
    for (const std::int64_t restart : {0, 5000}) {
      CAPTURE(wrong);
      CAPTURE(restart);
      Source source(Duration{0});
      SequenceCount count;
      for (std::int64_t k = 0; k < 7500; ++k) {
        const std::int64_t number = restart > 0 && k >= restart ? k - restart : k;
        count.push(k == 3750 ? wrong : static_cast<std::uint64_t>(number));
        CountedFrame& frame = source.frames[static_cast<std::size_t>(k)];
        frame.life = count.place().run + 1;
        frame.number = count.place().number;
      }
      const LearnedDevice counted = counted_clock(source.frames, 8e6);
      source.frames.erase(source.frames.begin() + 3750);
      source.sent.erase(source.sent.begin() + 3750);
      CHECK(source.worst(counted) < 20ms);
    }
  }
}

TEST_CASE("a source that stalls again and again keeps its rate, and its stamps rise") {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::vector<CountedFrame> frames;
    HostTime at{};
    for (std::int64_t k = 0; k < 400; ++k) {  // 4 s, of which half a window is even
      at += 10ms;
      if (random() % 28 == 0) at += 20ms + Duration{random() % 110'000'000};
      frames.push_back({1, k, at + Duration{random() % 400'000}});
    }
    for (const double stated_ns : {0.0, 1e7}) {
      const LearnedDevice counted = counted_clock(frames, stated_ns);
      CHECK(counted.findings.empty());
      CHECK(counted.step_ns == doctest::Approx(1e7).epsilon(0.01));
      std::optional<Time> last;
      for (const CountedFrame& frame : frames) {
        const NodeTime n = counter_of(frame, counted.step_ns);
        const auto stamp = stamp_of(counted.clock, 1, n, frame.arrival);
        REQUIRE(stamp);
        const Time now = take_time(counted.clock.time, *stamp);
        if (last) CHECK(now > *last);
        last = now;
      }
    }
  }
}

TEST_CASE("a rate that is stated wrongly is said, and not believed") {
  const Source source(0s);
  const LearnedDevice counted = counted_clock(source.frames, 1e9 / 60.0);
  REQUIRE(counted.findings.size() == 1);
  CHECK(counted.findings[0].what.expected == "60 Hz, as stated");
  CHECK(source.worst(counted) < 2500us);
}

TEST_CASE("a busy radio's delays do not shake a rate that is stated rightly") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::exponential_distribution<double> more(1.0 / 0.030);  // link C: 33 ms in the mean
    std::vector<CountedFrame> frames;
    for (std::int64_t k = 0; k < 225; ++k) {  // 15 s of the paper's nodes
      const Duration way = 3500us + Duration{std::llround(1e9 * more(random))};
      frames.push_back({1, k, HostTime{Duration{k * 66'666'667} + way}});
    }
    const LearnedDevice counted = counted_clock(frames, 1e9 / 15.0);
    CHECK(counted.findings.empty());
    CHECK(counted_clock(frames, 0.0).step_ns == doctest::Approx(1e9 / 15.0).epsilon(0.01));
  }
}
