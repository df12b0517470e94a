// SPDX-License-Identifier: Apache-2.0
// Rules for angles and poses of any skeleton.
#include "tests/motion/chains.h"
#include "tests/motion/rotations.h"
#include "tests/seeds.h"

#include "kinalign/motion/kinematics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <random>

using namespace kinalign;

namespace {

std::vector<double> positions_of(const Chain& chain) {
  std::vector<double> out(chain.frames.local_positions.size(), -7.0);
  forward_kinematics(chain.skeleton, chain.frames, out);
  return out;
}

double worst_distance(std::span<const double> a, std::span<const double> b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size() / 3; ++i) {
    worst = std::max(worst, (vec3(a, i) - vec3(b, i)).norm());
  }
  return worst;
}

/// Whether `joint` is `of` or one of its descendants.
bool hangs_on(const Skeleton& skeleton, std::size_t joint, std::size_t of) {
  for (auto j = static_cast<int>(joint); j >= 0;
       j = skeleton.parents[static_cast<std::size_t>(j)]) {
    if (j == static_cast<int>(of)) return true;
  }
  return false;
}

/// A new order of the joints, new place -> old place, in which parents still come first.
std::vector<std::size_t> another_order(const Skeleton& skeleton, std::mt19937_64& random) {
  std::vector<std::size_t> order, waiting(skeleton.joints());
  std::iota(waiting.begin(), waiting.end(), std::size_t{0});
  std::vector<bool> placed(skeleton.joints());
  while (!waiting.empty()) {
    const auto at = static_cast<std::ptrdiff_t>(random() % waiting.size());
    const std::size_t j = waiting[static_cast<std::size_t>(at)];
    const int parent = skeleton.parents[j];
    if (parent >= 0 && !placed[static_cast<std::size_t>(parent)]) continue;
    placed[j] = true;
    order.push_back(j);
    waiting.erase(waiting.begin() + at);
  }
  return order;
}

Chain reordered(const Chain& chain, const std::vector<std::size_t>& order) {
  const std::size_t joints = order.size();
  std::vector<int> place(joints);
  for (std::size_t k = 0; k < joints; ++k) place[order[k]] = static_cast<int>(k);
  Chain out = chain;
  for (std::size_t k = 0; k < joints; ++k) {
    const int parent = chain.skeleton.parents[order[k]];
    out.skeleton.parents[k] = parent < 0 ? parent : place[static_cast<std::size_t>(parent)];
    for (std::size_t t = 0; t < chain.frames.size(); ++t) {
      const std::size_t to = t * joints + k, from = t * joints + order[k];
      vec3(out.frames.local_positions, to) = vec3(chain.frames.local_positions, from);
      put_quat(out.frames.local_rotations, to, quat(chain.frames.local_rotations, from));
    }
  }
  return out;
}

Quat turn_by(const EulerOrder& order, const std::array<double, 3>& degrees) {
  std::array<double, 4> q{};
  rotations_from_euler(order, {{&degrees[0], &degrees[1], &degrees[2]}, 3, q.data(), 4}, 1);
  return quat(q, 0);
}

constexpr std::array<EulerOrder, 6> orders{
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

}  // namespace

TEST_CASE("whoever is carried elsewhere as a whole keeps the pose") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::size_t joints = 1 + random() % 30, frames = 1 + random() % 40;
    Chain chain = random_chain(joints, frames, random);
    std::vector<double> expected = positions_of(chain);
    const Quat turn = random_rotation(random);
    const Vec3 shift = 3.0 * random_direction(random);
    for (std::size_t i = 0; i < joints * frames; ++i) {
      vec3(expected, i) = Vec3(turn * vec3(expected, i) + shift);
      if (chain.skeleton.parents[i % joints] >= 0) continue;
      auto place = vec3(chain.frames.local_positions, i);
      place = Vec3(turn * place + shift);
      put_quat(chain.frames.local_rotations, i, turn * quat(chain.frames.local_rotations, i));
    }
    CHECK(worst_distance(positions_of(chain), expected) <= 1e-13 * static_cast<double>(joints));
  }
}

TEST_CASE("no pose stretches a bone") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::size_t joints = 2 + random() % 30;
    const Chain chain = random_chain(joints, 1 + random() % 40, random);
    const auto found = positions_of(chain);
    for (std::size_t i = 0; i < found.size() / 3; ++i) {
      const int parent = chain.skeleton.parents[i % joints];
      if (parent < 0) continue;
      const std::size_t up = i - i % joints + static_cast<std::size_t>(parent);
      const double length = (vec3(found, i) - vec3(found, up)).norm();
      CHECK(std::abs(length - vec3(chain.frames.local_positions, i).norm()) <= 1e-13 * 30);
    }
  }
}

TEST_CASE("a joint that turns moves what hangs on it and nothing else") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::size_t joints = 2 + random() % 20, frames = 1 + random() % 40;
    Chain chain = random_chain(joints, frames, random);
    const auto before = positions_of(chain);
    const std::size_t turned = random() % joints, frame = random() % frames;
    const std::size_t at = frame * joints + turned;
    put_quat(chain.frames.local_rotations, at, random_rotation(random));
    const auto after = positions_of(chain);
    for (std::size_t i = 0; i < joints * frames; ++i) {
      const bool below = i / joints == frame && i % joints != turned &&
                         hangs_on(chain.skeleton, i % joints, turned);
      CHECK((vec3(before, i) != vec3(after, i)) == below);
      if (!below) continue;
      // The joint stays on a sphere about the joint that turned.
      const double radius = (vec3(before, i) - vec3(before, at)).norm();
      CHECK(std::abs((vec3(after, i) - vec3(after, at)).norm() - radius) <= 1e-12);
    }
  }
}

TEST_CASE("joints stand where they stand in whatever order they are counted") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::size_t joints = 1 + random() % 30, frames = 1 + random() % 40;
    const Chain chain = random_chain(joints, frames, random);
    const auto order = another_order(chain.skeleton, random);
    const auto found = positions_of(chain), other = positions_of(reordered(chain, order));
    for (std::size_t i = 0; i < joints * frames; ++i) {
      CHECK(vec3(other, i) == vec3(found, i - i % joints + order[i % joints]));
    }
  }
}

TEST_CASE("a body of twice the size stands twice as far, to the last bit") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    Chain chain = random_chain(1 + random() % 30, 20, random);
    auto expected = positions_of(chain);
    for (double& length : expected) length *= 2.0;
    for (double& length : chain.frames.local_positions) length *= 2.0;
    CHECK(positions_of(chain) == expected);
  }
}

TEST_CASE("the same three turns backwards, in the opposite order, undo each other") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> any(-720.0, 720.0);
    for (const EulerOrder& order : orders) {
      const std::array<double, 3> angles{any(random), any(random), any(random)};
      const Quat there = turn_by(order, angles);
      const Quat back =
          turn_by({order.third, order.second, order.first}, {-angles[2], -angles[1], -angles[0]});
      CHECK(angle_between(there * back, Quat::Identity()) <= 1e-14);
    }
  }
}

TEST_CASE("turns about one axis add up, and whole turns are none") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> any(-180.0, 180.0);
    for (const EulerOrder& order : orders) {
      const double a = any(random), b = any(random);
      const auto turns = static_cast<double>(static_cast<int>(random() % 2000001) - 1000000);
      CHECK(angle_between(turn_by(order, {0, a, 0}) * turn_by(order, {0, b, 0}),
                          turn_by(order, {0, a + b, 0})) <= 2e-14);
      // b + 360 turns has lost the digits of b that are smaller than its own last digit.
      const double wound = b + 360.0 * turns;
      CHECK(angle_between(turn_by(order, {a, 0, wound}),
                          turn_by(order, {a, 0, std::remainder(wound, 360.0)})) <= 2e-14);
    }
  }
}

TEST_CASE("angles of thousands of millions of turns still make a rotation") {
  for (const double size : {1e3, 1e6, 1e9, 1e12, 1e15}) {
    CAPTURE(size);
    for (const EulerOrder& order : orders) {
      const Quat q = turn_by(order, {size, -0.7 * size, 0.3 * size});
      CHECK(std::abs(q.norm() - 1.0) <= 2e-15);
    }
  }
}
