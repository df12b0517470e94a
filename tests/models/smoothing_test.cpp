// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/smoothing.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

using namespace kinalign;

namespace {

const std::vector<float> bumpy{0, 1, 4, 2, -1, 3, 5, 2, 0, -2, 1, 6};

std::vector<float> smoothed(const Smoothing& how, std::vector<float> values,
                            std::size_t channels = 1) {
  smooth(how, channels, values);
  return values;
}

void check_near(const std::vector<float>& values, const std::vector<double>& wanted) {
  REQUIRE(values.size() == wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    CAPTURE(i);
    CHECK(std::abs(values[i] - wanted[i]) < 2e-6);  // float's rounding of numbers below 8
  }
}

}  // namespace

TEST_CASE("smoothing: the weights of five and seven frames are Savitzky's and Golay's") {
  // Anal. Chem. 36(8), 1964, table I: order 2 (and 3).
  const std::vector<double> five{-3, 12, 17, 12, -3}, seven{-2, 3, 6, 7, 6, 3, -2};
  const auto w5 = polynomial_weights(5, 2, 2.0), w7 = polynomial_weights(7, 2, 3.0);
  for (std::size_t i = 0; i < 5; ++i) CHECK(w5[i] == doctest::Approx(five[i] / 35).epsilon(1e-12));
  for (std::size_t i = 0; i < 7; ++i) CHECK(w7[i] == doctest::Approx(seven[i] / 21).epsilon(1e-12));
}

TEST_CASE("smoothing: at the last frame the weights of a line are the closed ones") {
  // Least squares of a line over n frames, at frame n - 1: (4 - 6 (n - i) / (n + 1)) (-1) / n ...
  // written out: w_i = 2 (3 i - n + 2) / (n (n + 1)), i = 0 ... n - 1.
  for (const std::size_t n : {3U, 5U, 9U, 15U}) {
    const auto weights = polynomial_weights(n, 1, static_cast<double>(n) - 1.0);
    for (std::size_t i = 0; i < n; ++i) {
      const double whole = static_cast<double>(n), at = static_cast<double>(i);
      const double wanted = 2.0 * (3.0 * at - whole + 2.0) / (whole * (whole + 1.0));
      CHECK(weights[i] == doctest::Approx(wanted).epsilon(1e-12));
    }
  }
  // SciPy 1.10.1: savgol_coeffs(5, 2, pos=4, use='dot')
  const std::vector<double> scipy{3.0 / 35, -5.0 / 35, -3.0 / 35, 9.0 / 35, 31.0 / 35};
  const auto weights = polynomial_weights(5, 2, 4.0);
  for (std::size_t i = 0; i < 5; ++i) CHECK(weights[i] == doctest::Approx(scipy[i]).epsilon(1e-12));
}

TEST_CASE("smoothing: centred, it agrees with SciPy up to both ends") {
  // SciPy 1.10.1: savgol_filter([0,1,4,2,-1,3,5,2,0,-2,1,6], 5, 2, mode='interp'), then 7, 3
  check_near(smoothed({.window = 5, .order = 2}, bumpy),
             {-0.4571428571, 2.2285714286, 3.0571428571, 1.6571428571, 0.4571428571, 2.4857142857,
              4.2285714286, 2.6, -0.5142857143, -1.3142857143, 0.9428571429, 5.9142857143});
  check_near(smoothed({.window = 7, .order = 3}, bumpy),
             {-0.3571428571, 2.3333333333, 2.5476190476, 1.6190476190, 2.0952380952, 2.3333333333,
              2.9523809524, 2.2380952381, 0.0, -1.4047619048, 0.0952380952, 6.3333333333});
}

TEST_CASE("smoothing: causal, it takes the polynomial's value at the window's last frame") {
  // NumPy 1.24.2: polyval(polyfit(range(5), window, 2), 4) of each window of 5 that ends at the
  // frame; frames 0 to 3 are those of the first window's polynomial
  check_near(smoothed({.window = 5, .order = 2, .causal = true}, bumpy),
             {-0.4571428571, 2.2285714286, 3.0571428571, 2.0285714286, -0.8571428571, 1.7428571429,
              5.3428571429, 3.1142857143, -0.4285714286, -2.4, 0.5142857143, 5.9142857143});
}

TEST_CASE("smoothing: causal, no frame knows a later one") {
  const Smoothing how{.window = 5, .order = 2, .causal = true};
  auto other = bumpy;
  for (std::size_t i = 8; i < other.size(); ++i) other[i] += 100.0F;
  const auto a = smoothed(how, bumpy), b = smoothed(how, other);
  CHECK(std::vector<float>(a.begin(), a.begin() + 8) ==
        std::vector<float>(b.begin(), b.begin() + 8));
}

TEST_CASE("smoothing: a sequence shorter than the window has a window of its own length") {
  // NumPy 1.24.2: polyval(polyfit(range(4), [0,1,4,2], 2), range(4))
  check_near(smoothed({.window = 9, .order = 2}, {0, 1, 4, 2}), {-0.35, 2.05, 2.95, 2.35});
  CHECK(smoothed({.window = 9, .order = 2}, {3, 4}) == std::vector<float>{3, 4});
  CHECK(smoothed({.window = 9, .order = 2}, {3}) == std::vector<float>{3});
  CHECK(smoothed({.window = 9, .order = 2}, {}).empty());
}

TEST_CASE("smoothing: a window of 0 or 1 changes nothing") {
  CHECK(smoothed({.window = 0}, bumpy) == bumpy);
  CHECK(smoothed({.window = 1}, bumpy) == bumpy);
}

TEST_CASE("smoothing: a polynomial of the order stays what it is, channel by channel") {
  std::vector<float> values;
  for (int t = 0; t < 30; ++t) {
    const float x = static_cast<float>(t) * 0.1F;
    values.insert(values.end(), {1.0F - 2.0F * x + 0.5F * x * x, 3.0F * x});
  }
  for (const bool causal : {false, true}) {
    const auto out = smoothed({.window = 9, .order = 2, .causal = causal}, values, 2);
    for (std::size_t i = 0; i < out.size(); ++i) CHECK(std::abs(out[i] - values[i]) < 1e-5F);
  }
}
