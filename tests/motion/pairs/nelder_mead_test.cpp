// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/pairs/nelder_mead.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;

TEST_CASE("the simplex ends where SciPy's does") {
  // SciPy 1.10.1: minimize(f, [0.0, 0.0], method="Nelder-Mead") gives these after 146 calls.
  std::size_t calls = 0;
  const auto valley = [&calls](std::span<const double> x) {
    ++calls;
    return 100.0 * std::pow(x[1] - x[0] * x[0], 2.0) + std::pow(1.0 - x[0], 2.0);
  };
  const auto found = minimise(valley, {0.0, 0.0});
  CHECK(found[0] == doctest::Approx(1.00000439).epsilon(1e-8));
  CHECK(found[1] == doctest::Approx(1.00001064).epsilon(1e-8));
  CHECK(calls == 146);
}

TEST_CASE("one number is enough, and a start that is not 0") {
  const auto bowl = [](std::span<const double> x) { return std::abs(x[0] - 3.25); };
  CHECK(minimise(bowl, {1.0})[0] == doctest::Approx(3.25).epsilon(1e-4));
}
