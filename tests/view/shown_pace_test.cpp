// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/shown_pace.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <iterator>
#include <random>
#include <vector>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

constexpr Duration third = Duration{33'333'333};  // a third of 100 ms
const Time origin = utc_time(1'700'000'000'000'000'000);

std::vector<Time> frames_each(Duration step, Duration length) {
  std::vector<Time> frames;
  for (Duration at{}; at < length; at += step) frames.push_back(origin + at);
  return frames;
}

std::vector<Time> shown_of(const std::vector<Time>& frames) {
  ShownPace pace;
  std::vector<Time> shown;
  std::copy_if(frames.begin(), frames.end(), std::back_inserter(shown),
               [&pace](Time at) { return pace.shows(at); });
  return shown;
}

/// The largest number of frames within a second, its beginning included and its end not.
std::size_t most_in_a_second(const std::vector<Time>& shown) {
  std::size_t most = 0, first = 0;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    while (shown[i] - shown[first] >= 1s) ++first;
    most = std::max(most, i - first + 1);
  }
  return most;
}

/// Frames of 30 Hz, each up to `jitter` early or late.
std::vector<Time> jittered(Duration jitter, std::size_t n, std::mt19937_64& random) {
  std::vector<Time> frames;
  for (std::size_t i = 0; i < n; ++i) {
    const auto off =
        static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(2 * jitter.count() + 1));
    frames.push_back(origin + static_cast<std::int64_t>(i) * third + Duration{off} - jitter);
  }
  return frames;
}

}  // namespace

TEST_CASE("every second or fourth frame of a device at twice or four times 30 Hz is shown") {
  for (const int times : {1, 2, 4}) {
    CAPTURE(times);
    const auto frames = frames_each(third / times, 20s);
    std::vector<Time> expected;
    for (std::size_t i = 0; i < frames.size(); i += static_cast<std::size_t>(times)) {
      expected.push_back(frames[i]);
    }
    CHECK(shown_of(frames) == expected);
  }
}

TEST_CASE("at 100 and 125 Hz the nth that is shown is the first at most 4 ms before n thirtieths") {
  for (const Duration step : {Duration{10ms}, Duration{8ms}}) {
    CAPTURE(step.count());
    std::vector<Time> expected{origin};
    for (std::int64_t n = 1;; ++n) {
      const Duration earliest = n * third - Duration{4ms};
      const Duration at = (earliest + step - Duration{1}) / step * step;  // rounded up
      if (at >= 20s) break;
      expected.push_back(origin + at);
    }
    const auto shown = shown_of(frames_each(step, 20s));
    CHECK(shown == expected);
    CHECK(shown.size() == 600);
  }
}

TEST_CASE("a 30 Hz device that jitters by a millisecond is shown whole") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto frames = jittered(1ms, 900, random);
    CHECK(shown_of(frames) == frames);
  }
}

TEST_CASE("a Kinect whose steps are of two lengths is shown whole") {
  // Real steps: 32.98 and 34.03 ms, a third of them the longer one.
  std::vector<Time> frames{origin};
  for (int i = 1; i < 600; ++i)
    frames.push_back(frames.back() + (i % 3 == 0 ? 34'030us : 32'980us));
  CHECK(shown_of(frames) == frames);
}

TEST_CASE("whatever the rate, no second has more than 31 and the long run no more than 30 each") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::vector<Time> frames{origin};
    const std::uint64_t longest = 1'000'000 + random() % 40'000'000;
    while (frames.back() < origin + 60s) {
      frames.push_back(frames.back() + Duration{1 + static_cast<std::int64_t>(random() % longest)});
    }
    const auto shown = shown_of(frames);
    CHECK(most_in_a_second(shown) <= 31);
    CHECK(shown.size() <= 60 * 30 + 2);
  }
}

TEST_CASE("after a gap, and after a step back in time, the next frame is shown") {
  CHECK(shown_of({origin, origin + 10s, origin + 10s + third}).size() == 3);
  CHECK(shown_of({origin, origin - 1s, origin - 1s + 10ms, origin - 1s + third}) ==
        std::vector<Time>{origin, origin - 1s, origin - 1s + third});
}
