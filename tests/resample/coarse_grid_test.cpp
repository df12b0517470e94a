// SPDX-License-Identifier: Apache-2.0
#include "kinalign/resample/coarse_grid.h"

#include "tests/align/streams.h"

#include "kinalign/align/align.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace kinalign;
using namespace kinalign::test;

namespace {

/// A node, usually at 200 Hz, whose acceleration is a sine, aligned onto points of `grid_hz`.
Findings findings_of(double sine_hz, double amplitude, double grid_hz, std::int64_t step_ms = 5) {
  const auto stamps = every(step_ms * ms, static_cast<std::size_t>(4000 / step_ms));
  auto imu = nodes({"waist"}, stamps, [](std::size_t, double) { return Quat::Identity(); });
  for (std::size_t i = 0; i < imu.samples.size(); ++i) {
    const double t = 1e-9 * static_cast<double>(to_ns(stamps[i]));
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

TEST_CASE("a sine of 40 Hz does not, and the warning states the lost part") {
  const auto found = findings_of(40.0, 2.0, 60.0);
  REQUIRE(found.size() == 1);
  CHECK(found[0].severity == Severity::warning);
  CHECK(to_string(found[0].what) ==
        "imu: expected a grid that can represent the stream's content, found 100 % of the rms of "
        "waist's acceleration above what a 60 Hz grid can represent");
}

TEST_CASE("between them the share grows with the frequency") {
  CHECK(findings_of(10.0, 2.0, 60.0).empty());
  const auto found = findings_of(20.0, 2.0, 60.0);
  REQUIRE(found.size() == 1);
  // A sine at a third of the grid's rate.
  CHECK(found[0].what.found.starts_with("22 % of the rms"));
}

TEST_CASE("noise of the sensor's own size is no loss, nor is anything on a finer grid") {
  CHECK(findings_of(40.0, 0.05, 60.0).empty());
  CHECK(findings_of(40.0, 2.0, 200.0).empty());
}

TEST_CASE("a stream a little finer than the grid is judged, one of much the same rate is not") {
  CHECK(findings_of(40.0, 2.0, 60.0, 10).size() == 1);
  CHECK(findings_of(36.0, 2.0, 60.0, 12).size() == 1);
  CHECK(findings_of(30.0, 2.0, 60.0, 16).empty());
}

TEST_CASE("a sine loses what the cubic between the rows can't follow, by its share of their rate") {
  struct Share {
    double of_rate, lost;
  };
  constexpr double grid_s = 0.02, raw_s = 0.001;
  std::vector<double> at, rows, times, values;
  for (const Share& one :
       {Share{0.1, 0.003}, Share{0.25, 0.08}, Share{1.0 / 3.0, 0.22}, Share{0.5, 1.0}}) {
    CAPTURE(one.of_rate);
    const auto sine = [&](double t) {
      const double at_zero = one.of_rate == 0.5 ? 0.0 : 0.4;  // at half the rate all rows are zero
      return 3.0 + std::sin(2.0 * std::numbers::pi * one.of_rate / grid_s * t + at_zero);
    };
    at.clear(), rows.clear(), times.clear(), values.clear();
    for (int i = 0; i < 600; ++i) {
      at.push_back(grid_s * i);
      for (const double x : {sine(at.back()), 5.0, 0.0}) rows.push_back(x);
    }
    for (int i = 0; i < 12'000; ++i) {
      times.push_back(raw_s * i);
      for (const double x : {sine(times.back()), 5.0, 0.0}) values.push_back(x);
    }
    CarriedContent content;
    add_content({times, values, 3}, {at, rows, 3}, 0, content);
    CHECK(content.variation() == doctest::Approx(std::sqrt(0.5)).epsilon(0.01));
    CHECK(content.missing() / content.variation() == doctest::Approx(one.lost).epsilon(0.05));
  }
}

TEST_CASE("content is judged between the second row and the last but one, from four rows on") {
  const std::vector<double> times{0, 1, 2, 3, 4, 5}, values(18, 1.0);
  const auto samples = [&](const std::vector<double>& at) {
    CarriedContent content;
    const std::vector<double> rows(3 * at.size(), 1.0);
    add_content({times, values, 3}, {at, rows, 3}, 0, content);
    return content.samples;
  };
  CHECK(samples({0, 1, 4, 5}) == 3);  // 1, 2, 3
  CHECK(samples({0, 2, 5}) == 0);
  CHECK(samples({-9, -8, 8, 9}) == 6);
}
