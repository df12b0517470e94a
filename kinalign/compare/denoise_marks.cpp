// SPDX-License-Identifier: Apache-2.0
#include "kinalign/compare/denoise_marks.h"

#include "kinalign/models/joint_names.h"

#include <cmath>
#include <deque>
#include <span>

namespace kinalign {

namespace {

std::string person_and_action(const Pair& pair) { return pair.subject + "/" + pair.action; }

/// The shared joints of [T,J,3], in their order.
std::vector<double> shared_of(const std::array<std::size_t, shared_joint_count>& places,
                              std::size_t joints, const std::vector<float>& positions) {
  std::vector<double> out;
  out.reserve(positions.size() / joints * shared_joint_count);
  for (std::size_t row = 0; row + 3 * joints <= positions.size(); row += 3 * joints) {
    for (const std::size_t j : places) {
      for (std::size_t k = 0; k < 3; ++k) out.push_back(positions[row + 3 * j + k]);
    }
  }
  return out;
}

std::vector<std::uint8_t> shared_valid(const std::array<std::size_t, shared_joint_count>& places,
                                       std::size_t joints, const std::vector<std::uint8_t>& valid) {
  std::vector<std::uint8_t> out;
  for (std::size_t row = 0; row + joints <= valid.size(); row += joints) {
    for (const std::size_t j : places) out.push_back(valid[row + j]);
  }
  return out;
}

std::vector<double> in_centimetres(std::vector<double> values) {
  for (double& value : values) value *= 100.0;
  return values;
}

std::array<Bone, limb_bones.size()> limbs() {
  std::array<Bone, limb_bones.size()> out{};
  for (std::size_t b = 0; b < out.size(); ++b) out[b] = {limb_bones[b].a, limb_bones[b].b};
  return out;
}

}  // namespace

Result<DenoiseMarker> DenoiseMarker::make(const DenoiseLayout& layout,
                                          const std::vector<Pair>& pairs) {
  DenoiseMarker out;
  const auto names = kinect_names(layout.outputs);
  out.places_ = KA_TRY(shared_joints_among(names));
  out.joints_ = layout.outputs.size();
  out.rate_hz_ = layout.rate_hz;
  struct Copy {
    std::vector<double> truth;
    std::vector<std::uint8_t> valid;
  };
  std::map<std::string, std::deque<Copy>> takes;
  for (const Pair& pair : pairs) {
    takes[person_and_action(pair)].push_back({shared_of(out.places_, out.joints_, pair.truth),
                                              shared_valid(out.places_, out.joints_, pair.valid)});
  }
  for (const auto& [key, copies] : takes) {
    std::vector<Sequence> sequences;
    for (const Copy& copy : copies) {
      sequences.push_back({shared_joint_count, out.rate_hz_, copy.truth, copy.valid});
    }
    out.lengths_[key] = limb_lengths(sequences);
  }
  return out;
}

DenoiseMarks DenoiseMarker::marks_of(const Pair& pair, const std::vector<float>& answer,
                                     const std::vector<float>& spread) const {
  const auto truth = shared_of(places_, joints_, pair.truth);
  const auto predicted = shared_of(places_, joints_, answer);
  const auto valid = shared_valid(places_, joints_, pair.valid);
  const Sequence sequence{shared_joint_count, rate_hz_, truth, valid};
  DenoiseMarks out;
  out.protocol = protocol_marks(sequence, predicted, lengths_.at(person_and_action(pair)));
  const auto bones = limbs();
  out.table_nine =
      table_nine(in_centimetres(truth), in_centimetres(predicted), shared_joint_count, bones);
  double radii = 0.0;
  std::size_t within = 0;
  for (std::size_t i = 0; i < valid.size() && !spread.empty(); ++i) {
    if (valid[i] == 0) continue;
    const std::size_t frame = i / shared_joint_count, joint = places_[i % shared_joint_count];
    const double radius = radius_90 * spread[frame * joints_ + joint];
    const double distance =
        std::hypot(predicted[3 * i] - truth[3 * i], predicted[3 * i + 1] - truth[3 * i + 1],
                   predicted[3 * i + 2] - truth[3 * i + 2]);
    ++out.cells;
    radii += radius;
    if (distance <= radius) ++within;
  }
  if (out.cells > 0) {
    out.covered = static_cast<double>(within) / static_cast<double>(out.cells);
    out.radius_cm = 100.0 * radii / static_cast<double>(out.cells);
  }
  return out;
}

}  // namespace kinalign
