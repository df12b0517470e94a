// SPDX-License-Identifier: Apache-2.0
#include "kinalign/evaluate/bones.h"

#include "kinalign/evaluate/statistics.h"

#include <cassert>
#include <cmath>

namespace kinalign {

namespace {

// With fewer frames the standard deviation of a bone's length is not meaningful.
constexpr std::size_t least_cells = 5;

/// The lengths of a bone, m, in the frames in which both of its ends are valid.
std::vector<double> lengths_of(const Sequence& sequence, std::span<const double> places,
                               const Bone& bone) {
  std::vector<double> out;
  for (std::size_t t = 0; t < sequence.frames(); ++t) {
    if (!sequence.has(t, bone.a) || !sequence.has(t, bone.b)) continue;
    const std::size_t at = t * sequence.joints;
    out.push_back((vec3(places, at + bone.a) - vec3(places, at + bone.b)).norm());
  }
  return out;
}

}  // namespace

std::vector<std::optional<double>> median_lengths(std::span<const Sequence> take,
                                                  std::span<const Bone> bones) {
  std::vector<std::optional<double>> out(bones.size());
  for (std::size_t b = 0; b < bones.size(); ++b) {
    // The frames of all sequences are taken together: a bone has one length, and a median over more
    // frames is more exact.
    std::vector<double> all;
    for (const Sequence& sequence : take) {
      const auto lengths = lengths_of(sequence, sequence.truth, bones[b]);
      all.insert(all.end(), lengths.begin(), lengths.end());
    }
    if (!all.empty()) out[b] = quantile(std::move(all), 0.5);
  }
  return out;
}

std::optional<LengthMarks> length_marks(const Sequence& sequence, Prediction prediction,
                                        std::span<const Bone> bones,
                                        std::span<const std::optional<double>> given) {
  assert(prediction.size() == sequence.truth.size() && given.size() == bones.size());
  Mean error, constancy;
  for (std::size_t b = 0; b < bones.size(); ++b) {
    const auto lengths = lengths_of(sequence, prediction, bones[b]);
    if (!given[b] || lengths.size() < least_cells) continue;
    // The error is a mean over frames, so a bone that is seen often counts more. The constancy is a
    // mean over bones.
    for (const double length : lengths) error.add(std::abs(length - *given[b]));
    constancy.add(deviation(lengths));
  }
  if (error.count() == 0) return std::nullopt;
  return LengthMarks{error.value_or(0.0), constancy.value_or(0.0)};
}

}  // namespace kinalign
