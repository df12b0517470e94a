// SPDX-License-Identifier: Apache-2.0
#include "tests/align/streams.h"

#include "kinalign/align/align.h"

#include <doctest/doctest.h>

#include <numbers>

using namespace kinalign;
using namespace kinalign::test;

namespace {

/// A node at 200 Hz whose acceleration is a sine, aligned onto points of `grid_hz`.
Findings findings_of(double sine_hz, double amplitude, double grid_hz) {
  auto imu =
      nodes({"waist"}, every(5 * ms, 800), [](std::size_t, double) { return Quat::Identity(); });
  for (std::size_t i = 0; i < imu.samples.size(); ++i) {
    const double t = 0.005 * static_cast<double>(i);
    imu.samples.acceleration[3 * i] =
        amplitude * std::sin(2.0 * std::numbers::pi * sine_hz * t + 0.3);
  }
  const auto step = static_cast<std::int64_t>(1e9 / grid_hz);
  const auto rows = static_cast<std::size_t>(3.9 * grid_hz);
  Recording recording;
  recording.streams = {recorded("points", points({"a"}, every(step, rows, 11 * ms), wander)),
                       recorded("imu", imu)};
  const auto take = align(recording, {});
  REQUIRE(take);
  return take->report.findings;
}

}  // namespace

TEST_CASE("a sine of 5 Hz lies within what a 60 Hz grid carries") {
  CHECK(findings_of(5.0, 2.0, 60.0).empty());
}

TEST_CASE("a sine of 40 Hz does not, and the warning says how much of it is lost") {
  const auto found = findings_of(40.0, 2.0, 60.0);
  REQUIRE(found.size() == 1);
  CHECK(found[0].severity == Severity::warning);
  CHECK(to_string(found[0].what) ==
        "imu: expected a grid that carries the stream's content, found 100 % of the rms of waist's "
        "acceleration beyond what a 60 Hz grid carries");
}

TEST_CASE("between them the share grows with the frequency") {
  CHECK(findings_of(10.0, 2.0, 60.0).empty());
  const auto found = findings_of(20.0, 2.0, 60.0);
  REQUIRE(found.size() == 1);
  CHECK(found[0].what.found.starts_with("22 % of the rms"));  // of a third of the grid's rate
}

TEST_CASE("noise of the sensor's own size is no loss, nor is anything on a finer grid") {
  CHECK(findings_of(40.0, 0.05, 60.0).empty());
  CHECK(findings_of(40.0, 2.0, 200.0).empty());
}
