// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/live/certificate.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

using namespace kinalign;

namespace {

/// A function with the largest curvature that is allowed, in random directions, on a grid of one
/// second.
class Wanderer {
 public:
  Wanderer(const Assumptions& limits, std::mt19937_64& random) {
    double x = 0.0, rate = std::uniform_real_distribution<double>(-1.0, 1.0)(random) * limits.rate;
    for (int i = 0; i < 400; ++i) {
      double bend = (random() % 2 == 0 ? 1.0 : -1.0) * limits.curvature;
      if (std::abs(rate + bend) > limits.rate) bend = -bend;
      knots_.push_back({x, rate, bend});
      x += rate + bend / 2.0;
      rate += bend;
    }
  }
  double operator()(double t) const {
    const auto i = static_cast<std::size_t>(t);
    const double d = t - static_cast<double>(i);
    return knots_[i].x + knots_[i].rate * d + knots_[i].bend * d * d / 2.0;
  }

 private:
  struct Knot {
    double x, rate, bend;
  };
  std::vector<Knot> knots_;
};

}  // namespace

TEST_CASE("the truth lies in the range at every time while the assumptions hold") {
  for (const auto seed : fresh_seeds(60)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Assumptions limits{.rate = 100e-6, .curvature = random() % 2 == 0 ? 5e-8 : 2e-6};
    const Wanderer truth(limits, random);
    Certificate certificate(limits, random() % 2 == 0 ? 20 : 1000000);
    std::exponential_distribution<double> delay(1000.0), wait(10.0);
    double s = 0.0;
    for (int i = 0; i < 1000 && s < 150.0; ++i) {
      s += wait(random);
      certificate.add({s, truth(s) + delay(random), Side::above});
      const double later = s + delay(random);
      certificate.add({later, truth(later) - delay(random), Side::below});
      if (i % 20 != 19) continue;
      for (const double t : {s, s * 0.5, s + 100.0, std::fmod(s * 7.0, s)}) {
        const auto range = certificate.at(t);
        REQUIRE(range);
        CHECK(range->low <= truth(t) + 1e-12);
        CHECK(range->high >= truth(t) - 1e-12);
      }
    }
  }
}

TEST_CASE("a claim needs two bounds from above and one from below") {
  Certificate certificate({});
  certificate.add({0.0, 1.0, Side::above});
  CHECK(!certificate.at(0.0));
  certificate.add({0.1, 0.0, Side::below});
  CHECK(!certificate.bounded());
  CHECK(certificate.at(0.0));
  certificate.add({0.2, 1.0, Side::above});
  CHECK(certificate.bounded());
}

TEST_CASE("a function that bends more contradicts itself, and under a greater curvature does not") {
  Certificate certificate({});
  for (double s = 0.0; s < 60.0; s += 0.1) {
    const double x = 1e-6 * s * s / 2.0;
    certificate.add({s, x + 1e-5, Side::above});
    certificate.add({s + 0.05, x, Side::below});
  }
  CHECK(!certificate.at(60.0));
  const auto range = certificate.relaxed(2e-6).at(60.0);
  REQUIRE(range);
  CHECK(range->low <= 1.8e-3);
  CHECK(range->high >= 1.8e-3);
}

TEST_CASE("assumptions are printed with their units") {
  CHECK(to_string(Assumptions{}) == "H1-H5 rate<=100ppm curvature<=0.05ppm/s");
}
