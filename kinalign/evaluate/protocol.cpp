// SPDX-License-Identifier: Apache-2.0
#include "kinalign/evaluate/protocol.h"

#include "kinalign/evaluate/bones.h"
#include "kinalign/evaluate/position.h"
#include "kinalign/evaluate/smoothness.h"
#include "kinalign/motion/shared_joints.h"

#include <array>
#include <cassert>

namespace kinalign {

namespace {

// The units of UI-PRMD's protocol. The functions called below return metres.
constexpr double cm = 0.01, mm = 0.001;
constexpr std::size_t least_fitted_joints = 12;

/// The limb bones as indices in the shared joints.
std::array<Bone, limb_bones.size()> bones() {
  std::array<Bone, limb_bones.size()> out;
  for (std::size_t b = 0; b < out.size(); ++b) out[b] = {limb_bones[b].a, limb_bones[b].b};
  return out;
}

std::optional<double> mean_cm(const std::vector<double>& distances) {
  Mean mean;
  for (const double d : distances) mean.add(d / cm);
  return mean.value();
}

}  // namespace

/// All methods are compared with these lengths, so a method gains nothing by changing its bones
/// during the motion.
std::vector<std::optional<double>> limb_lengths(std::span<const Sequence> take) {
  return median_lengths(take, bones());
}

ProtocolMarks protocol_marks(const Sequence& sequence, Prediction prediction,
                             std::span<const std::optional<double>> lengths_m) {
  assert(sequence.joints == shared_joint_count && lengths_m.size() == limb_bones.size());
  ProtocolMarks out;
  out.position_cm = mean_cm(distances(sequence, prediction));
  out.fitted_cm = mean_cm(fitted_distances(sequence, prediction, least_fitted_joints));
  if (const auto lengths = length_marks(sequence, prediction, bones(), lengths_m)) {
    out.bone_cm = lengths->error_m / cm;
    out.constancy_cm = lengths->constancy_m / cm;
  }
  // The protocol measures time in frames, so the values are not divided by the frame time.
  out.acceleration_mm = acceleration_error(sequence, prediction).value_or(0.0) / mm;
  const Jitter third = jitter(sequence, prediction).value_or(Jitter{});
  out.jitter_mm = third.predicted / mm;
  out.true_jitter_mm = third.truth / mm;
  return out;
}

/// JIT is the mean predicted jitter divided by the mean true jitter. A mean of the ratios would
/// depend mostly on repetitions with little motion.
ProtocolMeans protocol_row(std::span<const ProtocolMarks> repetitions) {
  Mean position, fitted, bone, constancy, acceleration, jitter, true_jitter;
  // Absent measures are left out of their mean; they don't count as 0.
  const auto add = [](Mean& mean, const std::optional<double>& value) {
    if (value) mean.add(*value);
  };
  for (const ProtocolMarks& one : repetitions) {
    add(position, one.position_cm);
    add(fitted, one.fitted_cm);
    add(bone, one.bone_cm);
    add(constancy, one.constancy_cm);
    acceleration.add(one.acceleration_mm);
    jitter.add(one.jitter_mm);
    true_jitter.add(one.true_jitter_mm);
  }
  ProtocolMeans out{position.value(),           fitted.value(), bone.value(), constancy.value(),
                    acceleration.value_or(0.0), std::nullopt};
  if (true_jitter.value_or(0.0) > 0.0)
    out.jitter = jitter.value_or(0.0) / true_jitter.value_or(1.0);
  return out;
}

}  // namespace kinalign
