// SPDX-License-Identifier: Apache-2.0
#include "tools/kinect_table/marks.h"

#include "kinalign/evaluate/protocol.h"
#include "kinalign/motion/shared_joints.h"

#include <algorithm>
#include <array>
#include <span>

namespace kinalign {

namespace {

constexpr std::size_t joints = mapped_joints;
static_assert(joints == shared_joint_count);

constexpr double frames_hz = 30.0;

Sequence sequence_of(const Repetition& piece) {
  return {joints, frames_hz, piece.truth, piece.valid};
}

constexpr std::size_t window = 9;

/// Weights for a window of nine values that give the value at `at` in -4 … 4 of the quadratic
/// through them (Savitzky and Golay). They follow from the sums over k of 1, k^2 and k^4, which are
/// 9, 60 and 708.
std::array<double, window> quadratic_weights(double at) {
  std::array<double, window> weights{};
  constexpr double s0 = 9.0, s2 = 60.0, s4 = 708.0, apart = s0 * s4 - s2 * s2;
  for (std::size_t i = 0; i < window; ++i) {
    const double k = static_cast<double>(i) - 4.0;
    weights[i] = (s4 - s2 * k * k) / apart + at * k / s2 + at * at * (s0 * k * k - s2) / apart;
  }
  return weights;
}

std::vector<double> smoothed(const Repetition& piece) {
  std::vector<double> out = piece.kinect;
  if (piece.frames < window) return out;
  for (std::size_t t = 0; t < piece.frames; ++t) {
    const std::size_t first = std::clamp<std::size_t>(t, 4, piece.frames - 5) - 4;
    const auto weights =
        quadratic_weights(static_cast<double>(t) - static_cast<double>(first) - 4.0);
    for (std::size_t c = 0; c < 3 * joints; ++c) {
      double sum = 0.0;
      for (std::size_t i = 0; i < window; ++i) {
        sum += weights[i] * piece.kinect[(first + i) * 3 * joints + c];
      }
      out[t * 3 * joints + c] = sum;
    }
  }
  return out;
}

}  // namespace

void put_marks(const std::vector<Repetition>& pieces, Figures& figures) {
  std::vector<ProtocolMarks> marks, smoothed_marks;
  for (const TakeRange& range : takes(pieces)) {
    const std::span<const Repetition> take(&pieces[range.begin], range.end - range.begin);
    std::vector<Sequence> sequences;
    for (const Repetition& piece : take) sequences.push_back(sequence_of(piece));
    const auto lengths = limb_lengths(sequences);
    for (std::size_t i = 0; i < take.size(); ++i) {
      marks.push_back(protocol_marks(sequences[i], take[i].kinect, lengths));
      smoothed_marks.push_back(protocol_marks(sequences[i], smoothed(take[i]), lengths));
    }
  }
  const ProtocolMeans row = protocol_row(marks);
  figures.mpjpe = row.position_cm.value_or(0.0);
  figures.pa = row.fitted_cm.value_or(0.0);
  figures.bone = row.bone_cm.value_or(0.0);
  figures.constancy = row.constancy_cm.value_or(0.0);
  figures.acceleration = row.acceleration_mm;
  figures.acceleration_smoothed = protocol_row(smoothed_marks).acceleration_mm;
  figures.jitter = row.jitter.value_or(0.0);
}

}  // namespace kinalign
