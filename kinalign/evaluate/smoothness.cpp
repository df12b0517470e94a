// SPDX-License-Identifier: Apache-2.0
#include "kinalign/evaluate/smoothness.h"

#include "kinalign/evaluate/statistics.h"

#include <cassert>
#include <cmath>
#include <vector>

namespace kinalign {

namespace {

/// True if cell i and the cells of the same joint in the next frames are valid, `frames` cells in
/// all.
bool valid_from(const Sequence& sequence, std::size_t i, std::size_t frames) {
  for (std::size_t k = 0; k < frames; ++k) {
    const std::size_t cell = i + k * sequence.joints;
    if (cell >= sequence.valid.size() || sequence.valid[cell] == 0) return false;
  }
  return true;
}

Vec3 second_difference(std::span<const double> places, std::size_t i, std::size_t joints) {
  return vec3(places, i) - 2.0 * vec3(places, i + joints) + vec3(places, i + 2 * joints);
}

Vec3 third_difference(std::span<const double> places, std::size_t i, std::size_t joints) {
  return second_difference(places, i + joints, joints) - second_difference(places, i, joints);
}

/// The distances between successive frames [T-1,J], m, minus the mean of each joint over its valid
/// steps. With the mean left in, any two motions would correlate, because all distances are
/// positive.
struct Speeds {
  std::vector<double> values;
  std::vector<std::uint8_t> valid;
};

/// Step i leads from cell i (a joint in a frame) to the same joint one frame later.
Speeds centred_speeds(const Sequence& sequence, std::span<const double> places) {
  const std::size_t joints = sequence.joints;
  Speeds out;
  for (std::size_t i = 0; i + joints < sequence.valid.size(); ++i) {
    out.values.push_back((vec3(places, i + joints) - vec3(places, i)).norm());
    out.valid.push_back(valid_from(sequence, i, 2) ? 1 : 0);
  }
  for (std::size_t j = 0; j < joints; ++j) {
    Mean mean;
    for (std::size_t i = j; i < out.values.size(); i += joints) {
      if (out.valid[i] != 0) mean.add(out.values[i]);
    }
    for (std::size_t i = j; i < out.values.size(); i += joints) {
      out.values[i] -= mean.value_or(0.0);
    }
  }
  return out;
}

/// The correlation of the predicted speeds with the true speeds `lag` cells earlier; 0 if one of
/// the motions stands still.
double correlation(const Speeds& predicted, const Speeds& truth, std::ptrdiff_t lag) {
  const auto size = static_cast<std::ptrdiff_t>(truth.values.size());
  double both = 0.0, own = 0.0, true_square = 0.0;
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, -lag); i < size && i + lag < size; ++i) {
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(i + lag);
    if (truth.valid[a] == 0 || predicted.valid[b] == 0) continue;
    both += truth.values[a] * predicted.values[b];
    own += predicted.values[b] * predicted.values[b];
    true_square += truth.values[a] * truth.values[a];
  }
  const double scale = std::sqrt(own * true_square);
  return scale > 0.0 ? both / scale : 0.0;
}

}  // namespace

std::optional<double> acceleration_error(const Sequence& sequence, Prediction prediction) {
  assert(prediction.size() == sequence.truth.size());
  Mean mean;
  for (std::size_t i = 0; i < sequence.valid.size(); ++i) {
    // Only complete windows count. A padded frame would add a jump that is not in the prediction.
    if (!valid_from(sequence, i, 3)) continue;
    const Vec3 apart = second_difference(prediction, i, sequence.joints) -
                       second_difference(sequence.truth, i, sequence.joints);
    mean.add(apart.norm());
  }
  return mean.value();
}

std::optional<Jitter> jitter(const Sequence& sequence, Prediction prediction) {
  assert(prediction.size() == sequence.truth.size());
  Mean predicted, truth;
  for (std::size_t i = 0; i < sequence.valid.size(); ++i) {
    if (!valid_from(sequence, i, 4)) continue;
    predicted.add(third_difference(prediction, i, sequence.joints).norm());
    truth.add(third_difference(sequence.truth, i, sequence.joints).norm());
  }
  if (truth.count() == 0) return std::nullopt;
  return Jitter{predicted.value_or(0.0), truth.value_or(0.0)};
}

std::optional<double> lag_s(const Sequence& sequence, Prediction prediction,
                            std::size_t most_frames) {
  assert(prediction.size() == sequence.truth.size());
  const Speeds predicted = centred_speeds(sequence, prediction);
  const Speeds truth = centred_speeds(sequence, sequence.truth);
  const auto most = static_cast<std::ptrdiff_t>(most_frames);
  // The speeds of all joints stand in one array, so a lag of one frame is `joints` cells.
  const auto joints = static_cast<std::ptrdiff_t>(sequence.joints);
  std::vector<double> all;
  for (std::ptrdiff_t lag = -most; lag <= most; ++lag) {
    all.push_back(correlation(predicted, truth, lag * joints));
  }
  std::size_t best = 0;
  for (std::size_t k = 1; k < all.size(); ++k) {
    if (all[k] > all[best]) best = k;
  }
  // If the best shift is the first or the last one, the true maximum may lie outside the range.
  if (best == 0 || best + 1 == all.size()) return std::nullopt;
  const double bend = all[best - 1] - 2.0 * all[best] + all[best + 1];
  // The top of the parabola through the best correlation and its two neighbours, in frames.
  const double part = bend < 0.0 ? 0.5 * (all[best - 1] - all[best + 1]) / bend : 0.0;
  return (static_cast<double>(best) - static_cast<double>(most) + part) / sequence.rate_hz;
}

std::optional<double> amplitude_ratio(const Sequence& sequence, Prediction prediction,
                                      std::size_t root) {
  assert(prediction.size() == sequence.truth.size() && root < sequence.joints);
  double predicted = 0.0, truth = 0.0;
  for (std::size_t j = 0; j < sequence.joints; ++j) {
    // Distances from the root do not change with the heading, so only the pose counts.
    std::vector<double> far, true_far;
    for (std::size_t t = 0; t < sequence.frames(); ++t) {
      if (!sequence.has(t, j) || !sequence.has(t, root)) continue;
      const std::size_t at = t * sequence.joints;
      far.push_back((vec3(prediction, at + j) - vec3(prediction, at + root)).norm());
      true_far.push_back((vec3(sequence.truth, at + j) - vec3(sequence.truth, at + root)).norm());
    }
    if (far.empty()) continue;
    predicted += deviation(far);
    truth += deviation(true_far);
  }
  if (!(truth > 0.0)) return std::nullopt;
  return predicted / truth;
}

}  // namespace kinalign
