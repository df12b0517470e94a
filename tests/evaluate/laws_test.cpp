// SPDX-License-Identifier: Apache-2.0
// Rules for every metric.
#include "tests/evaluate/moving_body.h"
#include "tests/seeds.h"

#include "kinalign/evaluate/feet.h"
#include "kinalign/evaluate/position.h"
#include "kinalign/evaluate/smoothness.h"
#include "kinalign/evaluate/table_nine.h"
#include "kinalign/evaluate/uncertainty.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>

using namespace kinalign;

namespace {

/// Changes every position by a function.
template <class Change>
std::vector<double> changed(const std::vector<double>& places, const Change& change) {
  std::vector<double> out = places;
  for (std::size_t i = 0; i < out.size() / 3; ++i) vec3(out, i) = change(Vec3(vec3(places, i)));
  return out;
}

doctest::Approx near(double value) { return doctest::Approx(value).epsilon(1e-9).scale(1e-3); }

}  // namespace

TEST_CASE("the truth itself has no error") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    const MovingBody body = moving_body(seed);
    const Sequence s = body.sequence();
    CHECK(mean_of(distances(s, body.truth)) == 0.0);
    CHECK(mean_of(fitted_distances(s, body.truth)) == near(0.0));
    CHECK(acceleration_error(s, body.truth) == 0.0);
    CHECK(jitter(s, body.truth)->ratio() == 1.0);
    CHECK(std::abs(lag_s(s, body.truth).value()) < 0.5 / body.rate_hz);
    CHECK(amplitude_ratio(s, body.truth, 0) == 1.0);
    const TableNine nine = table_nine(body.truth, body.truth, 18, some_bones);
    CHECK(nine.position == 0.0);
    CHECK(nine.bone == 0.0);
    CHECK(nine.smooth == nine.true_smooth);
  }
}

TEST_CASE("a constant shift is an error of the world alone") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    const MovingBody body = moving_body(seed);
    const Sequence s = body.sequence();
    const Vec3 shift(0.03, -0.04, 0.12);
    const auto moved = changed(body.truth, [&](const Vec3& p) -> Vec3 { return p + shift; });
    CHECK(mean_of(distances(s, moved)) == near(0.13));
    CHECK(mean_of(fitted_distances(s, moved)) == near(0.0));
    CHECK(acceleration_error(s, moved).value() == near(0.0));
    CHECK(jitter(s, moved)->ratio().value() == near(1.0));
  }
}

TEST_CASE("a similarity leaves nothing after the fit, a mirror image does") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    const MovingBody body = moving_body(seed);
    const Sequence s = body.sequence();
    const Quat turn = Quat(0.2, -0.4, 0.5, 0.7).normalized();
    const auto moved = changed(
        body.truth, [&](const Vec3& p) -> Vec3 { return 1.3 * (turn * p) + Vec3(1.0, 2.0, 3.0); });
    CHECK(mean_of(fitted_distances(s, moved)) == near(0.0));
    const auto mirrored = changed(body.truth, [](const Vec3& p) -> Vec3 {
      return {-p.x(), p.y(), p.z()};
    });
    CHECK(mean_of(fitted_distances(s, mirrored)) > 0.01);
  }
}

TEST_CASE("truth and prediction may change places in errors of position and acceleration") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    const MovingBody body = moving_body(seed);
    const Sequence s = body.sequence();
    Sequence swapped = s;
    swapped.truth = body.prediction;
    CHECK(mean_of(distances(s, body.prediction)) == near(mean_of(distances(swapped, body.truth))));
    CHECK(acceleration_error(s, body.prediction).value() ==
          near(acceleration_error(swapped, body.truth).value()));
  }
}

TEST_CASE("cells that are not valid do not count") {
  MovingBody body = moving_body(7);
  const Sequence s = body.sequence();
  const auto marks = [&] {
    return std::array{mean_of(distances(s, body.prediction)),
                      mean_of(fitted_distances(s, body.prediction)),
                      acceleration_error(s, body.prediction).value(),
                      jitter(s, body.prediction)->predicted,
                      lag_s(s, body.prediction).value(),
                      amplitude_ratio(s, body.prediction, 0).value()};
  };
  const auto before = marks();
  for (std::size_t i = 0; i < body.valid.size(); ++i) {
    if (body.valid[i] == 0) vec3(body.prediction, i) = Vec3(1e6, -1e6, 1e6);
  }
  CHECK(marks() == before);
}

TEST_CASE("a delay is found to a part of a frame, and a flattened motion by its amplitude") {
  const auto place = [](double t, std::size_t j) {
    return Vec3(0.3 * std::sin(1.1 * t * t / 4.0 + static_cast<double>(j)), 0.0, 0.0);
  };
  for (const double delay_s : {-0.11, 0.0, 0.05, 0.1}) {
    CAPTURE(delay_s);
    std::vector<double> truth(200 * 4 * 3), late(200 * 4 * 3);
    const std::vector<std::uint8_t> valid(200 * 4, 1);
    for (std::size_t i = 0; i < 200 * 4; ++i) {
      const double t = static_cast<double>(i / 4) / 30.0;
      vec3(truth, i) = i % 4 == 0 ? Vec3(Vec3::Zero()) : place(t, i % 4);
      vec3(late, i) = i % 4 == 0 ? Vec3(Vec3::Zero()) : Vec3(place(t - delay_s, i % 4));
    }
    const Sequence s{4, 30.0, truth, valid};
    CHECK(lag_s(s, late).value() == doctest::Approx(delay_s).epsilon(0.002).scale(1.0));
    const auto flat = changed(truth, [](const Vec3& p) -> Vec3 { return 0.5 * p; });
    CHECK(amplitude_ratio(s, flat, 0).value() == near(0.5));
  }
}

TEST_CASE("a foot that slides while the true one stands skates") {
  // Two joints: a foot that stands for 20 frames and swings for 20, and a hip.
  std::vector<double> truth(40 * 2 * 3);
  for (std::size_t t = 0; t < 40; ++t) {
    vec3(truth, 2 * t) = Vec3(0.0, t < 20 ? 0.08 : 0.4, t < 20 ? 0.0 : 0.05 * double(t - 20));
    vec3(truth, 2 * t + 1) = Vec3(0.0, 1.0, 0.0);
  }
  const std::vector<std::uint8_t> valid(80, 1);
  const Sequence s{2, 30.0, truth, valid};
  std::vector<double> slid = truth;
  for (std::size_t t = 0; t < 40; ++t) {
    vec3(slid, 2 * t) += Vec3(0.01 * double(t), -0.02, 0.0);
  }
  const std::array<std::size_t, 1> foot{0};
  const auto marks = feet_marks(s, slid, foot);
  REQUIRE(marks);
  CHECK(marks->contacts == 19);  // frame 0 has no speed
  CHECK(marks->skate_m_s == near(0.3));
  CHECK(marks->true_skate_m_s == 0.0);
  CHECK_FALSE(feet_marks(s, slid, std::array<std::size_t, 1>{1}, {.highest_m = -1.0}));
}

TEST_CASE("stated radii that know the error are smaller than one radius of the same coverage") {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  RadiusMarks knowing, constant;
  for (int i = 0; i < 30000; ++i) {
    const double sigma = i % 2 == 0 ? 0.01 : 0.04;
    const double error = sigma * Vec3(normal(random), normal(random), normal(random)).norm();
    (i < 15000 ? knowing : constant).add(error, 2.5003 * (i < 15000 ? sigma : 0.03));
  }
  // 2.5003: the square root of chi-squared's 90 % point with three degrees of freedom.
  CHECK(knowing.covered() == doctest::Approx(0.9).epsilon(0.01));
  CHECK(knowing.mean_radius_m() == doctest::Approx(2.5003 * 0.025));
  CHECK(knowing.one_radius_m() > 1.2 * knowing.mean_radius_m());
  CHECK(constant.one_radius_m() == doctest::Approx(constant.mean_radius_m()).epsilon(0.02));
  RadiusMarks both = knowing;
  both.add(constant);
  CHECK(both.cells == 30000);
  CHECK(both.within == knowing.within + constant.within);
}

TEST_CASE("own-root data of a body that walks and turns stand still") {
  const MovingBody body = moving_body(5);
  const OwnRootJoints own{0, 10, 14, 4, 7};
  const auto still = own_root(body.truth, 18, own);
  std::vector<double> walking = body.truth;
  for (std::size_t i = 0; i < walking.size() / 3; ++i) {
    const double t = static_cast<double>(i / 18);
    vec3(walking, i) = Quat(Eigen::AngleAxisd(0.1 * t, Vec3::UnitY())) * Vec3(vec3(body.truth, i)) +
                       Vec3(0.02 * t, 0.0, -0.05 * t);
  }
  const auto again = own_root(walking, 18, own);
  for (std::size_t i = 0; i < still.size(); ++i) CHECK(again[i] == near(still[i]));
}

TEST_CASE("without a valid cell every mark is absent") {
  MovingBody body = moving_body(3, 10);
  std::fill(body.valid.begin(), body.valid.end(), std::uint8_t{0});
  const Sequence s = body.sequence();
  CHECK(distances(s, body.prediction).empty());
  CHECK(fitted_distances(s, body.prediction).empty());
  CHECK_FALSE(acceleration_error(s, body.prediction));
  CHECK_FALSE(jitter(s, body.prediction));
  CHECK_FALSE(lag_s(s, body.prediction));
  CHECK_FALSE(amplitude_ratio(s, body.prediction, 0));
  CHECK_FALSE(feet_marks(s, body.prediction, two_feet));
}
