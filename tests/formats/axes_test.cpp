// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/axes.h"

#include "tests/seeds.h"

#include "kinalign/formats/imu_converter.h"
#include "kinalign/formats/point_rows.h"
#include "kinalign/motion/arrays.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;

namespace {

/// All 48 ways to map three axes to three axes, with signs.
std::vector<Axes> all_axes() {
  std::vector<Axes> out;
  Axes order{1, 2, 3};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Axes axes = order;
      for (std::size_t k = 0; k < 3; ++k) axes[k] *= (signs >> k & 1) != 0 ? -1 : 1;
      out.push_back(axes);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return out;
}

Vec3 any_vector(std::mt19937_64& random) {
  std::uniform_real_distribution<double> range(-3, 3);
  return {range(random), range(random), range(random)};
}

Vec3 ours(const Axes& axes, const Vec3& file) { return turned(axes, file.data()); }

StreamOptions up(const std::string& axis) {
  StreamOptions options;
  options.up = axis;
  return options;
}

}  // namespace

TEST_CASE("half of all axes are a turn, half a mirror image, and a repeated one is neither") {
  int turns = 0;
  for (const Axes& axes : all_axes()) {
    // A rotation keeps the sign of the cross product; a mirror image changes it.
    const Vec3 crossed = ours(axes, Vec3::UnitX()).cross(ours(axes, Vec3::UnitY()));
    const Vec3 third = ours(axes, Vec3::UnitZ());
    CHECK(determinant(axes) == (crossed == third ? 1 : -1));
    CHECK(crossed == determinant(axes) * third);
    turns += determinant(axes) > 0 ? 1 : 0;
  }
  CHECK(turns == 24);
  CHECK(determinant({1, 1, 3}) == 0);
  CHECK(determinant({2, -2, 3}) == 0);
}

TEST_CASE("axes as a rotation turn what axes as names turn") {
  for (const std::uint64_t seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Vec3 v = any_vector(random);
    for (const Axes& axes : all_axes()) {
      if (determinant(axes) < 0) continue;
      CHECK((rotation_of(axes) * v - ours(axes, v)).norm() < 1e-14);
    }
  }
}

TEST_CASE("z up becomes y up by a quarter turn about x: x stays, z rises, y comes from behind") {
  CHECK(ours(z_up, Vec3::UnitX()) == Vec3::UnitX());
  CHECK(ours(z_up, Vec3::UnitZ()) == Vec3::UnitY());
  CHECK(ours(z_up, Vec3::UnitY()) == -Vec3::UnitZ());
  CHECK(determinant(z_up) == 1);
  CHECK(determinant(y_up) == 1);
}

TEST_CASE("the user's up axis takes precedence over the format's") {
  const Axes odd{-3, 2, 1};
  CHECK(axes_of(odd, up("")) == odd);
  CHECK(axes_of(odd, up("y")) == y_up);
  CHECK(axes_of(odd, up("z")) == z_up);
  StreamOptions options;
  CHECK(point_units({odd, 0.001}, options).metres == 0.001);
  options.metres_per_unit = 0.0254;
  CHECK(point_units({odd, 0.001}, options).metres == 0.0254);
  CHECK(point_units({odd, 0.001}, options).axes == odd);
}

TEST_CASE("points come out turned and in metres, missing ones as zeros, whatever the axes") {
  const std::vector<Tracking> states{Tracking::tracked, Tracking::missing, Tracking::inferred};
  for (const std::uint64_t seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (const Axes& axes : all_axes()) {
      std::vector<double> file;
      for (std::size_t i = 0; i < 9; ++i) file.push_back(any_vector(random).x());
      PointFrames out;
      append_points({axes, 0.01}, file.data(), states, out);
      CHECK(out.state == states);
      REQUIRE(out.positions.size() == 9);
      const auto joint = [&](std::size_t j) { return vec3(out.positions, j); };
      CHECK((joint(0) - 0.01 * turned(axes, &file[0])).norm() < 1e-16);
      CHECK(joint(1) == Vec3::Zero());
      CHECK((joint(2) - 0.01 * turned(axes, &file[6])).norm() < 1e-16);
    }
  }
}

TEST_CASE("a node's world turns with the axes, its own space does not") {
  // About y; quaternions of any length are accepted.
  const std::array<double, 4> half_turned{0, 0, 2, 0};
  const std::array<double, 3> a{1, 2, 3}, w{-90, 0, 90};
  for (const Axes& axes : all_axes()) {
    if (determinant(axes) < 0) continue;
    ImuSamples out;
    ImuConverter converter({axes, 9.80665, 0.5});
    converter.append({half_turned.data(), a.data(), w.data(), true}, out);
    REQUIRE(out.valid == std::vector<std::uint8_t>{1});
    const Quat q = quat(out.orientation, 0);
    CHECK(q.norm() == doctest::Approx(1.0).epsilon(1e-15));
    for (const Vec3& v : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
      const Vec3 in_file_world(-v.x(), v.y(), -v.z());
      CHECK((q * v - ours(axes, in_file_world)).norm() < 1e-14);
    }
    CHECK(out.acceleration == std::vector<double>{9.80665, 2 * 9.80665, 3 * 9.80665});
    CHECK(out.angular_velocity == std::vector<double>{-45, 0, 45});
  }
}

TEST_CASE("a sample of which anything is missing holds zeros in all its quantities") {
  const std::array<double, 4> zero{}, q{1, 0, 0, 0};
  const std::array<double, 3> a{1, 2, 3};
  ImuConverter converter({});
  ImuSamples out;
  converter.append({zero.data(), a.data(), a.data(), true}, out);
  converter.append({q.data(), a.data(), a.data(), false}, out);
  CHECK(out.valid == std::vector<std::uint8_t>{0, 0});
  CHECK(out.orientation == std::vector<double>(8, 0.0));
  CHECK(out.acceleration == std::vector<double>(6, 0.0));
  CHECK(out.angular_velocity == std::vector<double>(6, 0.0));
}

TEST_CASE("a quantity that a stream does not carry has no numbers") {
  const std::array<double, 3> a{1, 2, 3};
  ImuConverter converter({});
  ImuSamples out;
  converter.append({nullptr, a.data(), nullptr, true}, out);
  CHECK(out.orientation.empty());
  CHECK(out.angular_velocity.empty());
  CHECK(out.acceleration == std::vector<double>{1, 2, 3});
}
