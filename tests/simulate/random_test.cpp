// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/random.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("numbers are those of the reference, to the last bit") {
  // The check values are those of the reference simulator in Python.
  CHECK(mix64(0) == 0xe220a8397b1dcdafU);
  CHECK(mix64(1) == 0x910a2dec89025cc1U);
  const RandomStream stream(1, 10);
  CHECK(stream.uniform(0, 0) == 0.37246556801571923);
  CHECK(stream.uniform(1, 0) == 0.87004381644674611);
  CHECK(stream.uniform(2, 0) == 0.9144743218584932);
}

TEST_CASE("exponential and normal numbers have the moments of their laws") {
  const RandomStream stream(7, 1);
  constexpr int n = 100000;
  double mean = 0.0, square = 0.0, waits = 0.0;
  for (int k = 0; k < n; ++k) {
    const double z = stream.normal(static_cast<std::uint64_t>(k), 0);
    mean += z / n;
    square += z * z / n;
    waits += stream.exponential(static_cast<std::uint64_t>(k), 2, 3.0) / n;
  }
  // The limits are five standard errors.
  CHECK(std::abs(mean) < 5.0 / std::sqrt(n));
  CHECK(std::abs(square - 1.0) < 5.0 * std::sqrt(2.0 / n));
  CHECK(std::abs(waits - 3.0) < 5.0 * 3.0 / std::sqrt(n));
}
