// SPDX-License-Identifier: Apache-2.0
#include "kinalign/evaluate/rotations.h"

#include "kinalign/motion/rotation.h"

#include <cassert>
#include <cmath>

namespace kinalign {

std::optional<double> rotation_error(const RotationSequence& sequence,
                                     std::span<const double> prediction,
                                     std::span<const std::size_t> joints) {
  assert(prediction.size() == sequence.truth.size());
  Mean mean;
  for (std::size_t at = 0; at < sequence.valid.size(); at += sequence.joints) {
    for (const std::size_t j : joints) {
      if (sequence.valid[at + j] == 0) continue;
      const Quat apart = quat(sequence.truth, at + j).conjugate() * quat(prediction, at + j);
      mean.add(rotation_vector(apart.normalized()).norm());
    }
  }
  return mean.value();
}

std::optional<double> swing_error(const Sequence& sequence, Prediction prediction,
                                  std::span<const Bone> bones) {
  assert(prediction.size() == sequence.truth.size());
  Mean mean;
  for (std::size_t t = 0; t < sequence.frames(); ++t) {
    const std::size_t at = t * sequence.joints;
    for (const Bone& bone : bones) {
      if (!sequence.has(t, bone.a) || !sequence.has(t, bone.b)) continue;
      const Vec3 is = vec3(prediction, at + bone.b) - vec3(prediction, at + bone.a);
      const Vec3 was = vec3(sequence.truth, at + bone.b) - vec3(sequence.truth, at + bone.a);
      mean.add(std::atan2(is.cross(was).norm(), is.dot(was)));
    }
  }
  return mean.value();
}

}  // namespace kinalign
