// SPDX-License-Identifier: Apache-2.0
#include "kinalign/compare/linear.h"

#include "tests/models/bodies.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

/// People whose Kinect has a constant offset for each joint: `spread` m, with a random sign for
/// each person, or with one sign for all.
std::vector<Pair> people(std::size_t count, float spread, bool alike) {
  std::mt19937_64 random(11);
  std::vector<Pair> out;
  std::vector<float> offset(3 * standing_body.size());
  for (std::size_t p = 0; p < count; ++p) {
    if (p == 0 || !alike) {
      for (float& x : offset) x = random() % 2 == 0 ? spread : -spread;
    }
    Pair pair;
    pair.subject = std::to_string(p);
    pair.input = moving_body(120, p);
    std::normal_distribution<float> noise(0.0F, 0.005F);
    for (std::size_t i = 0; i < pair.input.positions.size(); ++i) {
      pair.truth.push_back(pair.input.positions[i] + offset[i % offset.size()] + noise(random));
    }
    pair.valid.assign(pair.input.seen.size(), 1);
    out.push_back(std::move(pair));
  }
  return out;
}

double ratio_of(const std::vector<Pair>& pairs) {
  const auto layout = denoise_layout(body_joint_names(), body_joint_names(), 30.0);
  REQUIRE(layout);
  return unseen_ratio(*layout, pairs);
}

}  // namespace

TEST_CASE("where people are alike, errors on a new one are not twice as large") {
  CHECK(ratio_of(people(4, 0.05F, true)) < 1.6);
}

TEST_CASE("where people differ, errors on a new one are much larger") {
  CHECK(ratio_of(people(4, 0.05F, false)) > 2.0);
}

TEST_CASE("one person does not show how people differ") {
  CHECK(ratio_of(people(1, 0.05F, true)) == doctest::Approx(1.5));
}
