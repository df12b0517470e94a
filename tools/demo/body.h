// SPDX-License-Identifier: Apache-2.0
// The demo's person: a skeleton with the names and the hierarchy of a Perception Neuron suit, and
// its motion at any time, by closed formulas.
#pragma once

#include "kinalign/motion/arrays.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

constexpr std::size_t demo_joints = 59;

/// The direction that the person faces, measured from +z towards +x. A suit's axes are those of its
/// calibration. The camera looks at the person's face, so its direction is another 180 degrees
/// away.
constexpr double demo_heading_deg = 58.7 - 180.0;

struct DemoJoint {
  std::string name;
  int parent = -1;
  Vec3 offset = Vec3::Zero();  // cm, from the parent; T-pose, y up, facing +z, left is +x
  Vec3 end = Vec3::Zero();     // cm, to the end site; zero: none
};

struct DemoBody {
  std::vector<DemoJoint> joints;  // [59] parents first

  std::size_t find(std::string_view name) const;
};

/// `scale` 1: a person of 1.75 m.
DemoBody demo_body(double scale);

/// The pose at one moment, as in a row of a BVH file: R = Ry Rx Rz, degrees, and positions in cm
/// that replace the offsets.
struct DemoPose {
  std::array<Vec3, demo_joints> positions;
  std::array<Vec3, demo_joints> angles;  // about y, x, z
};

/// Positions, m, and rotations of all joints in the space of the floor.
struct DemoPlaces {
  std::array<Vec3, demo_joints> positions;
  std::array<Quat, demo_joints> rotations;
};

/// Random numbers from a seed (SplitMix64).
class DemoRandom {
 public:
  explicit DemoRandom(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits();
  double uniform(double least, double most);
  /// Mean 0, deviation 1, never beyond 3.5 (a sum of four uniforms).
  double normal();

 private:
  std::uint64_t state_;
};

/// A person who stands in T-pose, then waves, bends and steps, every 20 s anew. Twice continuously
/// differentiable in time.
class DemoMotion {
 public:
  DemoMotion(DemoBody body, std::uint64_t seed);

  /// The pose at any time `t`, s.
  DemoPose pose(double t) const;
  DemoPlaces places(double t) const;
  const DemoBody& body() const { return body_; }

 private:
  struct Named;

  DemoBody body_;
  std::array<std::size_t, 17> used_{};  // the joints that move, in the order of Named
  double wave_ = 1, bend_ = 1, step_ = 1, wave_hz_ = 1.2, step_hz_ = 0.9;
};

}  // namespace kinalign
