// SPDX-License-Identifier: Apache-2.0
#include "tests/seeds.h"
#include "tests/witness.h"

#include "kinalign/formats/xdf/xdf.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace kinalign;

namespace {

/// Clock offsets every 5 s from `first` on: offset + slope * time.
std::vector<XdfClockOffset> line(double first, std::size_t count, double offset, double slope) {
  std::vector<XdfClockOffset> offsets;
  for (std::size_t k = 0; k < count; ++k) {
    const double time = first + 5.0 * static_cast<double>(k);
    offsets.push_back({1, time, offset + slope * time});
  }
  return offsets;
}

std::vector<XdfClockOffset> joined(std::vector<XdfClockOffset> a,
                                   const std::vector<XdfClockOffset>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

TEST_CASE("xdf clock: a straight drift is found and taken away") {
  const auto lines = fit_xdf_clock(line(50'000.0, 100, -3.0, 20e-6));
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].slope == doctest::Approx(20e-6).epsilon(1e-6));
  CHECK(lines[0].largest_residual < 1e-9);
  CHECK(lines[0].offsets == 100);
  CHECK(corrected_xdf_stamp(lines, 50'100.0) ==
        doctest::Approx(50'100.0 - 3.0 + 20e-6 * 50'100.0).epsilon(1e-14));
}

TEST_CASE("xdf clock: no offset moves nothing, one moves all alike") {
  CHECK(corrected_xdf_stamp(fit_xdf_clock({}), 7.0) == 7.0);
  const std::vector<XdfClockOffset> one{{1, 6.0, -0.125}};
  CHECK(corrected_xdf_stamp(fit_xdf_clock(one), 100.0) == 99.875);
}

TEST_CASE("xdf clock: outliers do not bend the line, and its residual shows them") {
  auto offsets = line(0.0, 60, 0.5, 10e-6);
  offsets[10].offset += 0.3;
  offsets[40].offset -= 5.0;  // the offset leaves and comes back: no reset
  const auto lines = fit_xdf_clock(offsets);
  REQUIRE(lines.size() == 1);
  CHECK(corrected_xdf_stamp(lines, 150.0) == doctest::Approx(150.5 + 10e-6 * 150.0).epsilon(1e-6));
  CHECK(lines[0].largest_residual == doctest::Approx(5.0).epsilon(1e-4));
  CHECK(lines[0].rms_residual == doctest::Approx(std::sqrt((25.0 + 0.09) / 60.0)).epsilon(1e-4));
}

TEST_CASE("xdf clock: a reset begins a line of its own") {
  // The sender restarts: its clock begins at 0, and the offset leaps by the clock's earlier value.
  const auto restarted = joined(line(1000.0, 20, 1.0, 0.0), line(0.0, 20, 1101.0, 0.0));
  auto lines = fit_xdf_clock(restarted);
  REQUIRE(lines.size() == 2);
  CHECK(corrected_xdf_stamp(lines, 1050.0) == doctest::Approx(1051.0));
  CHECK(corrected_xdf_stamp(lines, 50.0) == doctest::Approx(1151.0));
  CHECK(corrected_xdf_stamp(lines, 400.0) == doctest::Approx(1501.0));  // nearer to the second line
  // The clock was set ahead by 60 s.
  lines = fit_xdf_clock(joined(line(0.0, 20, 1.0, 0.0), line(160.0, 20, -59.0, 0.0)));
  REQUIRE(lines.size() == 2);
  CHECK(corrected_xdf_stamp(lines, 95.0) == doctest::Approx(96.0));
  CHECK(corrected_xdf_stamp(lines, 165.0) == doctest::Approx(106.0));
}

TEST_CASE("xdf clock: time that steps back is a reset, and the later line counts where both are") {
  const auto lines = fit_xdf_clock(joined(line(1000.0, 20, 1.0, 0.0), line(1000.0, 20, 1.5, 0.0)));
  REQUIRE(lines.size() == 2);
  CHECK(corrected_xdf_stamp(lines, 1050.0) == doctest::Approx(1051.5).epsilon(1e-9));
}

TEST_CASE("xdf clock: the widest numbers that a file may give make a line of numbers") {
  const std::vector<XdfClockOffset> wide{{1, -9e14, 9e14}, {1, 0.0, 9e14}, {1, 9e14, 9e14}};
  const auto lines = fit_xdf_clock(wide);
  REQUIRE(lines.size() == 1);
  CHECK(corrected_xdf_stamp(lines, 0.0) == doctest::Approx(9e14));
}

TEST_CASE("xdf clock: a step of less than a second is none") {
  CHECK(fit_xdf_clock(joined(line(0.0, 20, 0.0, 0.0), line(100.0, 20, 0.9, 0.0))).size() == 1);
}

TEST_CASE("xdf clock: the line is SciPy's by the Huber loss above 0.1 ms") {
  for (const auto seed : fresh_seeds(3)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise(0.0, 0.0003);
    auto offsets = line(50'000.0, 80, 0.25, 30e-6);
    for (auto& o : offsets) o.offset += noise(random) + (random() % 10 == 0 ? 0.02 : 0.0);
    std::vector<double> times, values;
    for (const auto& o : offsets) {
      times.push_back(o.time);
      values.push_back(o.offset);
    }
    const auto found = run_python("huber_line.py", {{"times", times}, {"values", values}});
    const auto lines = fit_xdf_clock(offsets);
    REQUIRE(lines.size() == 1);
    for (const double stamp : {50'000.0, 50'200.0, 50'400.0}) {
      const double theirs = found.at("line").at(0) + found.at("line").at(1) * (stamp - 50'000.0);
      // SciPy stops at a change of 1e-12 of its own loss, which is flat there: a microsecond is far
      // below the limit of 0.1 ms.
      CHECK(std::abs(corrected_xdf_stamp(lines, stamp) - stamp - theirs) < 1e-6);
    }
  }
}
