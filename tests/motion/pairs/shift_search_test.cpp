// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/pairs/shift_search.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;

namespace {

constexpr std::size_t joints = 18;

/// A body that never repeats itself.
Vec3 place(std::size_t j, double t) {
  const double k = static_cast<double>(j);
  return {0.1 * k + 0.2 * std::sin(1.3 * t + k), 0.05 * k * k / 18.0 + 0.3 * std::sin(2.1 * t),
          0.2 * std::cos(0.7 * t * t / 3.0 + 0.5 * k)};
}

std::vector<double> frames(std::size_t count, double rate_hz, double start_s,
                           const RigidTransform& transform = {}) {
  std::vector<double> out(3 * joints * count);
  for (std::size_t i = 0; i < joints * count; ++i) {
    const double t = start_s + static_cast<double>(i / joints) / rate_hz;
    vec3(out, i) = transform * place(i % joints, t);
  }
  return out;
}

}  // namespace

TEST_CASE("a known shift is found to a step, in any space") {
  const RigidTransform transform{Quat(0.1, 0.8, -0.3, 0.4).normalized(), Vec3(1.0, -2.0, 0.5)};
  const auto precise = frames(150, 50.0, 0.0);
  const PieceCurve curve({precise, {}, joints, 50.0});
  for (const double shift : {-0.4, -0.103, 0.0, 0.05, 0.31}) {
    CAPTURE(shift);
    const auto rough = frames(80, 30.0, shift, transform);
    const auto found = find_shift({rough, {}, joints, 30.0}, curve);
    REQUIRE(found);
    CHECK(std::abs(found->shift_s - shift) <= 0.0051);  // half a step of 0.01 s
    CHECK(found->rms_m < 0.005);
  }
}

TEST_CASE("four fifths of the shorter piece must overlap") {
  const auto precise = frames(151, 50.0, 0.0);  // 3 s
  const auto rough = frames(61, 30.0, 2.0);     // 2 s, of which 1 s overlaps
  const auto found = find_shift({rough, {}, joints, 30.0}, PieceCurve({precise, {}, joints, 50.0}));
  REQUIRE(found);
  CHECK(found->shift_s <= 3.0 - 0.8 * 2.0 + 0.03 + 1e-9);
}

TEST_CASE("a point is valid where both samples around are, and within the piece") {
  const auto precise = frames(11, 50.0, 0.0);
  std::vector<std::uint8_t> valid(11 * joints, 1);
  valid[5 * joints + 3] = 0;
  const PieceCurve curve({precise, valid, joints, 50.0});
  const CurvePoints points = curve.at(-0.05, 25.0, 8);  // at samples -2.5, -0.5, 1.5, 3.5, 5.5, ...
  std::vector<int> valid_3, valid_4;
  for (std::size_t i = 0; i < 8; ++i) {
    valid_3.push_back(points.valid[i * joints + 3]);
    valid_4.push_back(points.valid[i * joints + 4]);
  }
  CHECK(valid_3 == std::vector<int>{0, 0, 1, 1, 0, 1, 1, 0});
  CHECK(valid_4 == std::vector<int>{0, 0, 1, 1, 1, 1, 1, 0});
  const Vec3 found = vec3(points.positions, 3 * joints + 4);
  CHECK((found - place(4, 3.5 / 50.0)).norm() < 1e-4);  // the natural spline's end
  CHECK(vec3(points.positions, 4).norm() == 0.0);
}

TEST_CASE("without five frames of valid points there is no shift") {
  const auto precise = frames(50, 50.0, 0.0);
  const std::vector<std::uint8_t> none(50 * joints, 0);
  const auto rough = frames(30, 30.0, 0.0);
  CHECK_FALSE(find_shift({rough, {}, joints, 30.0}, PieceCurve({precise, none, joints, 50.0})));
  const auto short_rough = frames(4, 30.0, 0.0);
  CHECK_FALSE(find_shift({short_rough, {}, joints, 30.0}, PieceCurve({precise, {}, joints, 50.0})));
}
