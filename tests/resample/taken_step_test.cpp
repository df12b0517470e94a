// SPDX-License-Identifier: Apache-2.0
// The step that is found for a device, and whether it is known well enough to find late samples.
#include "kinalign/resample/taken_step.h"

#include "tests/align/streams.h"

#include <doctest/doctest.h>

#include <utility>

using namespace kinalign;
using namespace kinalign::test;

namespace {

/// Stretches, each of a number of steps of some ms.
std::vector<Time> stretches(const std::vector<std::pair<int, double>>& parts, int times = 1) {
  std::vector<Time> out{utc_time(0)};
  double t = 0.0;
  for (int k = 0; k < times; ++k) {
    for (const auto& [count, step_ms] : parts) {
      for (int i = 0; i < count; ++i) {
        t += step_ms;
        out.push_back(utc_time(std::llround(t * 1e6)));
      }
    }
  }
  return out;
}

TakenStep taken(const std::vector<Time>& stamps, double rate_hz = 0.0) {
  StreamOptions options;
  options.rate_hz = rate_hz;
  const RecordedStream stream = recorded("kinect", points({"Head"}, stamps, wander));
  return taken_step(stream, options, Role::resampled);
}

/// Stamps of a loop that reads each `read_ms`, and each `reads` reads finds a second sample, 0.1 ms
/// later.
std::vector<Time> polled(double read_ms, int reads) {
  return stretches({{reads, read_ms}, {1, 0.1}}, 100);
}

double ms_of(const TakenStep& step) { return 1e-6 * static_cast<double>(step.ns); }

}  // namespace

TEST_CASE("without a stated rate the step is the median, steady where the usual ones agree") {
  CHECK(ms_of(taken(stretches({{600, 33.0}}))) == doctest::Approx(33.0).epsilon(0.01));
  CHECK(taken(stretches({{600, 33.0}})).steady);
  CHECK(taken(stretches({{700, 34.0}, {300, 30.0}})).steady);    // KinectMultiTrack
  CHECK(taken(stretches({{20, 33.0}, {1, 700.0}}, 30)).steady);  // losses
}

TEST_CASE("a device that changes its rate and stamps that are rounded have no steady step") {
  CHECK_FALSE(taken(stretches({{500, 40.0}, {700, 28.6}})).steady);   // 25, then 35 Hz
  CHECK_FALSE(taken(stretches({{600, 66.7}, {500, 40.0}})).steady);   // 15, then 25
  CHECK_FALSE(taken(stretches({{2, 20.0}, {1, 10.0}}, 300)).steady);  // 60 Hz in hundredths
}

TEST_CASE("a stall that is drained leaves the step steady, at any haste") {
  for (const double haste : {0.6, 0.75, 0.3}) {
    CAPTURE(haste);  // at 30 Hz, a second each ten: 29 samples wait when the first one arrives
    const int drained = static_cast<int>(std::lround(29.0 / (1.0 - haste)));
    const auto stamps =
        stretches({{299 - drained, 100.0 / 3}, {1, 1000.0}, {drained, haste * 100.0 / 3}}, 6);
    CHECK(ms_of(taken(stamps)) == doctest::Approx(100.0 / 3).epsilon(0.02));
    CHECK(taken(stamps).steady);
  }
}

TEST_CASE("a loop slower than its device has no steady step, but where the device's is stated") {
  CHECK(taken(polled(35.0, 20)).steady);  // 30 Hz: 5 % off
  CHECK_FALSE(taken(polled(20.0, 5)).steady);
  CHECK(taken(polled(20.0, 5), 60.0).steady);
  CHECK(ms_of(taken(polled(20.0, 5), 60.0)) == doctest::Approx(100.0 / 6));
}

TEST_CASE("a stated rate that is a tenth off is not believed, one that is quite another is") {
  const auto stamps = stretches({{600, 33.0}});
  CHECK(ms_of(taken(stamps, 27.0)) == doctest::Approx(33.0).epsilon(0.01));
  CHECK(ms_of(taken(stamps, 300.0)) == doctest::Approx(1000.0 / 300));
}

TEST_CASE("the median stays for rates around the stated one, and is steady within 8 %") {
  const auto seven = stretches({{930, 1000.0 / 93}, {1070, 1000.0 / 107}});
  CHECK(ms_of(taken(seven, 100.0)) == doctest::Approx(1000.0 / 107).epsilon(0.01));
  CHECK(taken(stretches({{700, 30.0}, {300, 37.0}})).steady);        // 7 % on average
  CHECK_FALSE(taken(stretches({{700, 30.0}, {300, 40.0}})).steady);  // 10 %
}

TEST_CASE(
    "losses of 3 % together with stalls of 10 % leave no steady step, nor do rounded stamps") {
  // A stall of one second in each ten, drained at 0.75 of the step, with samples of `lost_ms` lost.
  const auto lossy = [](double lost_ms) {
    return stretches({{183, 100.0 / 3}, {1, 1000.0 + lost_ms}, {116, 25.0}}, 6);
  };
  CHECK(taken(lossy(200.0)).steady);
  CHECK_FALSE(taken(lossy(400.0)).steady);
  CHECK(taken(lossy(400.0), 30.0).steady);
  CHECK_FALSE(taken(stretches({{2, 20.0},
                               {1, 10.0},
                               {2, 20.0},
                               {1, 10.0},
                               {2, 20.0},
                               {1, 10.0},
                               {1, 20.0},
                               {1, 60.0},
                               {1, 10.0}},
                              100))
                  .steady);
}

TEST_CASE("a stated rate is believed to be the median's within 5 %") {
  const auto rounded = stretches({{2, 20.0}, {1, 10.0}}, 300);
  CHECK_FALSE(taken(rounded, 60.0).steady);
  CHECK_FALSE(taken(rounded, 47.0).steady);
  CHECK(taken(rounded, 48.0).steady);
}
