// SPDX-License-Identifier: Apache-2.0
// Every metric against NumPy and SciPy (tests/witness/metrics.py).
#include "tests/evaluate/moving_body.h"
#include "tests/seeds.h"
#include "tests/witness.h"

#include "kinalign/evaluate/bones.h"
#include "kinalign/evaluate/feet.h"
#include "kinalign/evaluate/position.h"
#include "kinalign/evaluate/rotations.h"
#include "kinalign/evaluate/smoothness.h"
#include "kinalign/evaluate/table_nine.h"
#include "kinalign/evaluate/uncertainty.h"

#include <doctest/doctest.h>

#include <array>
#include <numeric>

using namespace kinalign;

namespace {

void check_same(const std::vector<double>& ours, const std::vector<double>& theirs) {
  REQUIRE(ours.size() == theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    CAPTURE(i);
    CHECK(ours[i] == doctest::Approx(theirs[i]).epsilon(1e-8).scale(1e-3));
  }
}

/// Unit rotations [cells,4].
std::vector<double> rotations(std::size_t cells, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<double> out(4 * cells);
  for (std::size_t i = 0; i < cells; ++i) {
    put_quat(out, i,
             Quat(normal(random), normal(random), normal(random), normal(random)).normalized());
  }
  return out;
}

void check_positions(const MovingBody& body, Arrays& found) {
  const Sequence s = body.sequence();
  const auto all = distances(s, body.prediction);
  const auto summary = summary_of(all).value();
  check_same({summary.mean_m, summary.median_m, summary.percentile_95_m}, found["distances"]);
  check_same({share_within(all, 0.05).value(), share_within(all, 0.1).value(),
              share_within(all, 0.15).value()},
             {found["shares"].begin(), found["shares"].end() - 1});
  CHECK(area_under_share(all).value() == doctest::Approx(found["shares"].back()).epsilon(1e-5));
  check_same({summary_of(root_aligned_distances(s, body.prediction, 0))->mean_m},
             found["root_aligned"]);
  check_same({summary_of(fitted_distances(s, body.prediction, Fit::rigid))->mean_m,
              summary_of(fitted_distances(s, body.prediction, Fit::similarity))->mean_m},
             found["fitted"]);
}

void check_motion(const MovingBody& body, Arrays& found) {
  const Sequence s = body.sequence();
  const auto bones = bone_marks(s, body.prediction, some_bones).value();
  check_same({bones.error_m, bones.bias_m, bones.constancy_m, bones.true_constancy_m},
             found["bones"]);
  const auto third = jitter(s, body.prediction).value();
  check_same({acceleration_error(s, body.prediction).value(), third.predicted, third.truth},
             found["smoothness"]);
  const auto lag = lag_s(s, body.prediction);
  check_same(lag ? std::vector{*lag} : std::vector<double>{}, found["lag"]);
  check_same({amplitude_ratio(s, body.prediction, 0).value()}, found["amplitude"]);
  const auto feet = feet_marks(s, body.prediction, two_feet, {1.5, 0.2, 3}).value();
  check_same(
      {static_cast<double>(feet.contacts), feet.skate_m_s, feet.true_skate_m_s, feet.penetration_m},
      found["feet"]);
  check_same({swing_error(s, body.prediction, some_bones).value()}, found["swing"]);
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
  const UnitScale scale = unit_scale(truth, 18);
  const TableNine unit =
      table_nine(scaled(truth, scale), scaled(prediction, scale), 18, some_bones);
  check_same({cm.position, cm.bone, cm.smooth, cm.true_smooth, unit.position, unit.bone,
              unit.smooth, unit.true_smooth},
             found["nine"]);
}

}  // namespace

TEST_CASE("metrics agree with NumPy and SciPy") {
  for (const auto seed : fresh_seeds(3)) {
    CAPTURE(seed);
    const MovingBody body = moving_body(seed);
    std::mt19937_64 random(seed);
    const auto turned = rotations(body.valid.size(), random);
    const auto true_turned = rotations(body.valid.size(), random);
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
                                             {"rotations", turned},
                                             {"true_rotations", true_turned},
                                             {"sigmas", sigmas}});
    check_positions(body, found);
    check_motion(body, found);
    check_table_nine(body, found);
    std::vector<std::size_t> all(18);
    std::iota(all.begin(), all.end(), std::size_t{0});
    check_same({rotation_error({18, true_turned, body.valid}, turned, all).value()},
               found["rotation"]);
    RadiusMarks radii;
    for (std::size_t i = 0; i < body.valid.size(); ++i) {
      const double error = (vec3(body.prediction, i) - vec3(body.truth, i)).norm();
      if (body.valid[i] != 0) radii.add(error, 2.5 * sigmas[i]);
    }
    check_same({radii.covered(), radii.mean_radius_m()}, found["radii"]);
    CHECK(radii.one_radius_m() == doctest::Approx(found["one_radius"].at(0)).epsilon(0.001));
  }
}
