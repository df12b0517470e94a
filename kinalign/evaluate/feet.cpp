// SPDX-License-Identifier: Apache-2.0
#include "kinalign/evaluate/feet.h"

#include "kinalign/evaluate/statistics.h"

#include <algorithm>
#include <cassert>

namespace kinalign {

namespace {

/// The height that 1 % of a foot's true heights stay below, m. The minimum itself would depend on a
/// single outlier. The floor is found for each foot, because ankles and toes have different
/// heights.
std::optional<double> floor_of(const Sequence& sequence, std::size_t foot) {
  std::vector<double> heights;
  for (std::size_t t = 0; t < sequence.frames(); ++t) {
    if (!sequence.has(t, foot)) continue;
    heights.push_back(vec3(sequence.truth, t * sequence.joints + foot).y());
  }
  if (heights.empty()) return std::nullopt;
  return quantile(std::move(heights), 0.01);
}

/// Marks the frames of contact [T]: valid in this and the previous frame, slow, near the floor, and
/// in runs of at least least_frames.
std::vector<std::uint8_t> contacts(const Sequence& sequence, std::size_t foot, double floor_m,
                                   const ContactOptions& options) {
  const std::size_t frames = sequence.frames();
  std::vector<std::uint8_t> out(frames);
  for (std::size_t t = 1; t < frames; ++t) {
    if (!sequence.has(t, foot) || !sequence.has(t - 1, foot)) continue;
    const std::size_t i = t * sequence.joints + foot;
    const Vec3 now = vec3(sequence.truth, i), before = vec3(sequence.truth, i - sequence.joints);
    const bool slow = (now - before).norm() * sequence.rate_hz < options.fastest_m_s;
    out[t] = slow && now.y() < floor_m + options.highest_m ? 1 : 0;
  }
  // Short runs, of contact or not, are set to 0; runs without contact are 0 already.
  for (auto begin = out.begin(); begin != out.end();) {
    const auto end = std::find_if(begin, out.end(), [begin](auto c) { return c != *begin; });
    if (end - begin < static_cast<std::ptrdiff_t>(options.least_frames)) std::fill(begin, end, 0);
    begin = end;
  }
  return out;
}

/// Horizontal speed since the previous frame, m/s.
double skate(std::span<const double> places, std::size_t i, const Sequence& sequence) {
  Vec3 step = vec3(places, i) - vec3(places, i - sequence.joints);
  step.y() = 0.0;
  return step.norm() * sequence.rate_hz;
}

/// The means of the predicted and the true skate over the same frames, so that they can be
/// compared.
struct FootMeans {
  Mean skate, true_skate;

  void add(const Sequence& sequence, Prediction prediction, std::size_t foot,
           const std::vector<std::uint8_t>& in_contact) {
    for (std::size_t t = 0; t < sequence.frames(); ++t) {
      if (in_contact[t] == 0) continue;
      const std::size_t i = t * sequence.joints + foot;
      skate.add(kinalign::skate(prediction, i, sequence));
      true_skate.add(kinalign::skate(sequence.truth, i, sequence));
    }
  }
};

}  // namespace

std::optional<FeetMarks> feet_marks(const Sequence& sequence, Prediction prediction,
                                    std::span<const std::size_t> feet,
                                    // The truth decides which frames are contacts, so a prediction
                                    // that lifts the foot is still measured.
                                    const ContactOptions& options) {
  assert(prediction.size() == sequence.truth.size());
  FootMeans means;
  for (const std::size_t foot : feet) {
    const auto floor_m = floor_of(sequence, foot);
    if (!floor_m) continue;
    means.add(sequence, prediction, foot, contacts(sequence, foot, *floor_m, options));
  }
  if (means.skate.count() == 0) return std::nullopt;
  return FeetMarks{means.skate.count(), means.skate.value_or(0.0), means.true_skate.value_or(0.0)};
}

}  // namespace kinalign
