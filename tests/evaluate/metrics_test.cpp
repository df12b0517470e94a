// SPDX-License-Identifier: Apache-2.0
// Every metric against NumPy and SciPy (tests/witness/metrics.py).
#include "tests/evaluate/moving_body.h"
#include "tests/seeds.h"
#include "tests/witness.h"

#include "kinalign/evaluate/feet.h"
#include "kinalign/evaluate/position.h"
#include "kinalign/evaluate/smoothness.h"
#include "kinalign/evaluate/table_nine.h"
#include "kinalign/evaluate/uncertainty.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

void check_same(const std::vector<double>& ours, const std::vector<double>& theirs) {
  REQUIRE(ours.size() == theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    CAPTURE(i);
    CHECK(ours[i] == doctest::Approx(theirs[i]).epsilon(1e-8).scale(1e-3));
  }
}

void check_positions(const MovingBody& body, Arrays& found) {
  const Sequence s = body.sequence();
  check_same({mean_of(distances(s, body.prediction))}, found["distances"]);
  check_same({mean_of(fitted_distances(s, body.prediction))}, found["fitted"]);
}

void check_motion(const MovingBody& body, Arrays& found) {
  const Sequence s = body.sequence();
  const auto third = jitter(s, body.prediction).value();
  check_same({acceleration_error(s, body.prediction).value(), third.predicted, third.truth},
             found["smoothness"]);
  const auto lag = lag_s(s, body.prediction);
  check_same(lag ? std::vector{*lag} : std::vector<double>{}, found["lag"]);
  check_same({amplitude_ratio(s, body.prediction, 0).value()}, found["amplitude"]);
  const auto feet = feet_marks(s, body.prediction, two_feet, {1.5, 0.2, 3}).value();
  check_same({static_cast<double>(feet.contacts), feet.skate_m_s, feet.true_skate_m_s},
             found["feet"]);
}

void check_table_nine(const MovingBody& body, Arrays& found) {
  const auto hundredfold = [](std::vector<double> values) {
    for (double& v : values) v *= 100.0;
    return values;
  };
  const TableNine cm =
      table_nine(hundredfold(body.truth), hundredfold(body.prediction), 18, some_bones);
  const OwnRootJoints own{0, 10, 14, 4, 7};
  const auto truth = own_root(body.truth, 18, own);
  const auto prediction = own_root(body.prediction, 18, own);
  const TableNine rooted = table_nine(hundredfold(truth), hundredfold(prediction), 18, some_bones);
  check_same({cm.position, cm.bone, cm.smooth, cm.true_smooth, rooted.position, rooted.bone,
              rooted.smooth, rooted.true_smooth},
             found["nine"]);
}

}  // namespace

TEST_CASE("metrics agree with NumPy and SciPy") {
  for (const auto seed : fresh_seeds(3)) {
    CAPTURE(seed);
    const MovingBody body = moving_body(seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> some(0.01, 0.05);
    std::vector<double> sigmas(body.valid.size()), bones;
    for (double& sigma : sigmas) sigma = some(random);
    for (const Bone& bone : some_bones) {
      bones.push_back(static_cast<double>(bone.a));
      bones.push_back(static_cast<double>(bone.b));
    }
    Arrays found = run_python("metrics.py", {{"truth", body.truth},
                                             {"prediction", body.prediction},
                                             {"valid", {body.valid.begin(), body.valid.end()}},
                                             {"bones", bones},
                                             {"sigmas", sigmas}});
    check_positions(body, found);
    check_motion(body, found);
    check_table_nine(body, found);
    RadiusMarks radii;
    for (std::size_t i = 0; i < body.valid.size(); ++i) {
      const double error = (vec3(body.prediction, i) - vec3(body.truth, i)).norm();
      if (body.valid[i] != 0) radii.add(error, 2.5 * sigmas[i]);
    }
    check_same({radii.covered(), radii.mean_radius_m()}, found["radii"]);
    CHECK(radii.one_radius_m() == doctest::Approx(found["one_radius"].at(0)).epsilon(0.001));
  }
}
