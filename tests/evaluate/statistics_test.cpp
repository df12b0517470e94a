// SPDX-License-Identifier: Apache-2.0
#include "kinalign/evaluate/statistics.h"

#include "tests/seeds.h"
#include "tests/witness.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace kinalign;

TEST_CASE("Wilcoxon's test, quantiles and the bootstrap agree with SciPy") {
  for (const auto seed : fresh_seeds(3)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.3, 1.0);
    std::vector<double> differences(10 + seed % 30), ties;
    for (double& d : differences) d = normal(random);
    for (int i = 0; i < 60; ++i) ties.push_back(std::round(2.0 * normal(random)));  // zeros, too
    auto found = run_python("paired.py", {{"differences", differences}, {"ties", ties}});
    const WilcoxonTest exact = wilcoxon_signed_rank(differences);
    const WilcoxonTest rough = wilcoxon_signed_rank(ties);
    const auto& tests = found["tests"];
    CHECK(exact.statistic == doctest::Approx(tests[0]));
    CHECK(exact.p == doctest::Approx(tests[1]).epsilon(1e-9));
    CHECK(rough.statistic == doctest::Approx(tests[2]));
    CHECK(rough.p == doctest::Approx(tests[3]).epsilon(1e-9));
    const std::vector<double> at{0.0, 0.025, 0.5, 0.77, 1.0};
    for (std::size_t i = 0; i < at.size(); ++i) {
      CHECK(quantile(differences, at[i]) == doctest::Approx(found["quantiles"][i]).epsilon(1e-12));
    }
    const MeanInterval ours = bootstrap_mean(differences, {.seed = seed, .draws = 20'000});
    const double width = found["interval"][2] - found["interval"][1];
    CHECK(ours.mean == doctest::Approx(found["interval"][0]));
    CHECK(std::abs(ours.low - found["interval"][1]) <
          0.05 * width);  // 20,000 draws: 0.01 is one sd
    CHECK(std::abs(ours.high - found["interval"][2]) < 0.05 * width);
  }
}

TEST_CASE("the smallest p of seven people who all win is 2 / 128") {
  const std::vector<double> all_win{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7};
  CHECK(wilcoxon_signed_rank(all_win).p == doctest::Approx(2.0 / 128.0));
  CHECK(wilcoxon_signed_rank({}).p == 1.0);
  CHECK(wilcoxon_signed_rank(std::vector<double>{0.0, 0.0}).pairs == 0);
}

TEST_CASE("Holm's correction multiplies by the tests that are left, and never falls") {
  // statsmodels' multipletests(p, method="holm") gives the same by its definition.
  const std::vector<double> corrected = holm(std::vector<double>{0.01, 0.04, 0.03, 0.5});
  CHECK(corrected[0] == doctest::Approx(0.04));
  CHECK(corrected[1] == doctest::Approx(0.09));
  CHECK(corrected[2] == doctest::Approx(0.09));
  CHECK(corrected[3] == doctest::Approx(0.5));
  CHECK(holm(std::vector<double>{0.9, 0.8})[0] == 1.0);
  CHECK(holm({}).empty());
}

TEST_CASE("the same seed gives the same interval, another one nearly the same") {
  const std::vector<double> people{3.1, 2.9, 4.0, 3.3, 3.8, 2.5, 3.0};
  const MeanInterval a = bootstrap_mean(people), b = bootstrap_mean(people);
  const MeanInterval c = bootstrap_mean(people, {.seed = 2});
  CHECK(a.low == b.low);
  CHECK(a.high == b.high);
  CHECK(a.low < a.mean);
  CHECK(c.low == doctest::Approx(a.low).epsilon(0.02));
}
