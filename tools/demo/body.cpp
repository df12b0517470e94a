// SPDX-License-Identifier: Apache-2.0
#include "tools/demo/body.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace kinalign {

namespace {

/// Collects joints; `side` is +1 for the left, -1 for the right.
class Builder {
 public:
  explicit Builder(double scale) : scale_(scale) {}

  int add(std::string name, int parent, Vec3 offset, const Vec3& end = Vec3::Zero()) {
    body_.joints.push_back({std::move(name), parent, offset * scale_, end * scale_});
    return static_cast<int>(body_.joints.size()) - 1;
  }

  void leg(const std::string& name, double side, int hips) {
    const int up = add(name + "UpLeg", hips, {9.25 * side, -1.59, 0});
    const int low = add(name + "Leg", up, {0, -41.87, 0});
    add(name + "Foot", low, {0, -41.87, 0}, {0, -7.69, 17.5});
  }

  void arm(const std::string& name, double side, int chest) {
    const int shoulder = add(name + "Shoulder", chest, {3.2 * side, 6.925, 0});
    const int arm = add(name + "Arm", shoulder, {12.8 * side, 0, 0});
    const int fore = add(name + "ForeArm", arm, {26.5 * side, 0, 0});
    const int hand = add(name + "Hand", fore, {26.0 * side, 0, 0});
    finger(name + "HandThumb", hand, side, {2.5 * side, 0, 3.0});
    double across = 2.0;  // z of the finger's root
    for (const char* one : {"Index", "Middle", "Ring", "Pinky"}) {
      const int in_hand = add(name + "InHand" + one, hand, {3.4 * side, 0.4, across});
      finger(name + "Hand" + one, in_hand, side, {5.3 * side, 0, 0.4 * across});
      across -= 1.4;
    }
  }

  DemoBody take() { return std::move(body_); }

 private:
  void finger(const std::string& name, int parent, double side, const Vec3& root) {
    const int first = add(name + "1", parent, root);
    const int second = add(name + "2", first, {3.6 * side, 0, 0});
    add(name + "3", second, {2.2 * side, 0, 0}, {1.9 * side, 0, 0});
  }

  double scale_;
  DemoBody body_;
};

/// A step from 0 at x = 0 to 1 at x = 1, twice continuously differentiable.
double rise(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10 + x * (6 * x - 15));
}

/// 1 inside of `from` to `to`; it rises and falls within 0.8 s inside these ends.
double within(double t, double from, double to) {
  constexpr double ramp = 0.8;
  return rise((t - from) / ramp) * rise((to - t) / ramp);
}

double turn(double hz, double t) { return std::sin(2 * std::numbers::pi * hz * t); }

Quat rotation(const Vec3& yxz) {
  const Vec3 r = yxz * (std::numbers::pi / 180);
  return Quat(Eigen::AngleAxisd(r[0], Vec3::UnitY()) * Eigen::AngleAxisd(r[1], Vec3::UnitX()) *
              Eigen::AngleAxisd(r[2], Vec3::UnitZ()));
}

}  // namespace

std::size_t DemoBody::find(std::string_view name) const {
  const auto found = std::find_if(joints.begin(), joints.end(),
                                  [&](const DemoJoint& joint) { return joint.name == name; });
  if (found == joints.end()) std::abort();
  return static_cast<std::size_t>(found - joints.begin());
}

DemoBody demo_body(double scale) {
  Builder build(scale);
  const int hips = build.add("Hips", -1, {0, 93.02, 0});
  build.leg("Right", -1, hips);
  build.leg("Left", 1, hips);
  const int spine = build.add("Spine", hips, {0, 14.307, 0});
  const int spine1 = build.add("Spine1", spine, {0, 9.718, 0});
  const int spine2 = build.add("Spine2", spine1, {0, 10.12, 0});
  const int spine3 = build.add("Spine3", spine2, {0, 9.718, 0});
  const int neck = build.add("Neck", spine3, {0, 10.387, 0});
  build.add("Head", neck, {0, 9.47, 0}, {0, 15.95, 0});
  build.arm("Right", -1, spine3);
  build.arm("Left", 1, spine3);
  return build.take();
}

std::uint64_t DemoRandom::bits() {
  std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

double DemoRandom::uniform(double least, double most) {
  return least + (most - least) * static_cast<double>(bits() >> 11) * 0x1p-53;
}

double DemoRandom::normal() {
  const double sum = uniform(-1, 1) + uniform(-1, 1) + uniform(-1, 1) + uniform(-1, 1);
  return sum * std::sqrt(0.75);
}

struct DemoMotion::Named {
  enum Joint : std::size_t {
    hips,
    right_up_leg,
    right_leg,
    right_foot,
    left_up_leg,
    left_leg,
    left_foot,
    spine,
    spine1,
    spine2,
    spine3,
    head,
    right_arm,
    right_fore_arm,
    left_arm,
    left_fore_arm,
    right_hand
  };
};

DemoMotion::DemoMotion(DemoBody body, std::uint64_t seed) : body_(std::move(body)) {
  constexpr std::array<std::string_view, 17> names{
      "Hips",     "RightUpLeg",   "RightLeg", "RightFoot",   "LeftUpLeg", "LeftLeg",
      "LeftFoot", "Spine",        "Spine1",   "Spine2",      "Spine3",    "Head",
      "RightArm", "RightForeArm", "LeftArm",  "LeftForeArm", "RightHand"};
  for (std::size_t i = 0; i < names.size(); ++i) used_[i] = body_.find(names[i]);
  DemoRandom random(seed);
  for (double* size : {&wave_, &bend_, &step_}) *size = random.uniform(0.85, 1.15);
  wave_hz_ = random.uniform(1.0, 1.4);
  step_hz_ = random.uniform(0.8, 1.0);
}

DemoPose DemoMotion::pose(double t) const {
  DemoPose pose;
  for (std::size_t j = 0; j < demo_joints; ++j) {
    pose.positions[j] = body_.joints[j].offset;
    pose.angles[j].setZero();
  }
  const auto angles = [&](std::size_t joint) -> Vec3& { return pose.angles[used_[joint]]; };
  const double u = t - 20 * std::floor(t / 20);  // 0..3 T-pose, waves, bends, steps, T-pose
  const double down = within(u, 3, 20);
  const double wave = wave_ * within(u, 5, 9);
  const double bend = bend_ * within(u, 9, 13);
  const double step = step_ * within(u, 13, 19.5);
  const double swing = turn(step_hz_, u);
  const double left = step * (0.5 - 0.5 * turn(step_hz_, u + 0.25 / step_hz_));
  const double right = step * (0.5 + 0.5 * turn(step_hz_, u + 0.25 / step_hz_));

  angles(Named::hips) = {8 * step * turn(0.3, u) + 4 * down * turn(0.05, t), 18 * bend, 0};
  for (const auto joint : {Named::spine, Named::spine1, Named::spine2, Named::spine3}) {
    angles(joint) = {3 * step * swing, 9 * bend + 0.4 * turn(0.25, t), 0};
  }
  angles(Named::head) = {12 * down * turn(0.11, u), 4 * bend, 2 * turn(0.17, t)};
  angles(Named::left_arm) = {0, 14 * step * swing, -78 * down};
  angles(Named::left_fore_arm) = {-15 * down, 0, 0};
  angles(Named::right_arm) = {0, -14 * step * swing, 78 * down - 120 * wave};
  angles(Named::right_fore_arm) = {15 * down, 0, wave * (-35 + 28 * turn(wave_hz_, u))};
  angles(Named::right_hand) = {0, 0, 12 * wave * turn(wave_hz_, u - 0.1)};
  angles(Named::left_up_leg) = {0, -18 * bend - 34 * left, 0};
  angles(Named::left_leg) = {0, 52 * left, 0};
  angles(Named::left_foot) = {0, -16 * left, 0};
  angles(Named::right_up_leg) = {0, -18 * bend - 34 * right, 0};
  angles(Named::right_leg) = {0, 52 * right, 0};
  angles(Named::right_foot) = {0, -16 * right, 0};

  pose.positions[0] += Vec3{4 * step * swing, 0.3 * turn(0.25, t) - 1.5 * step, 0};
  pose.positions[0].z() += 25 * step * turn(0.15, u) - 7 * bend;
  // R = Ry Rx Rz, so a turn of the whole body about y adds to the first angle of the root.
  angles(Named::hips)[0] += demo_heading_deg;
  pose.positions[0] = rotation({demo_heading_deg, 0, 0}) * pose.positions[0];
  // Real suits stretch the legs a little to keep the feet in their places; so does this one.
  pose.positions[used_[Named::left_foot]].y() -= 0.8 * left;
  pose.positions[used_[Named::right_foot]].y() -= 0.8 * right;
  return pose;
}

DemoPlaces DemoMotion::places(double t) const {
  const DemoPose here = pose(t);
  DemoPlaces places;
  for (std::size_t j = 0; j < demo_joints; ++j) {
    const Quat local = rotation(here.angles[j]);
    const Vec3 offset = here.positions[j] * 0.01;
    if (body_.joints[j].parent < 0) {
      places.positions[j] = offset;
      places.rotations[j] = local;
      continue;
    }
    const auto p = static_cast<std::size_t>(body_.joints[j].parent);
    places.positions[j] = places.positions[p] + places.rotations[p] * offset;
    places.rotations[j] = places.rotations[p] * local;
  }
  return places;
}

}  // namespace kinalign
