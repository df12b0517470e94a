// SPDX-License-Identifier: Apache-2.0
#include "kinalign/compare/denoise_marks.h"

#include "kinalign/evaluate/smoothness.h"
#include "kinalign/models/joint_names.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <span>

namespace kinalign {

namespace {

// Indices of joints in shared_joints.
constexpr std::array<std::size_t, 2> wrists{6, 9};
constexpr std::array<std::size_t, 4> shared_feet{12, 13, 16, 17};
constexpr OwnRootJoints shared_root{
    .root = 0, .hip_left = 10, .hip_right = 14, .shoulder_left = 4, .shoulder_right = 7};

/// The group of each shared joint, as an index in radius_groups.
constexpr std::array<std::size_t, shared_joint_count> group_of{0, 0, 0, 0, 0, 1, 1, 0, 1,
                                                               1, 0, 2, 2, 2, 0, 2, 2, 2};

/// Returns the mean position error of both wrists, over the frames in which they are valid.
std::optional<double> hand_error_cm(const Sequence& sequence, Prediction prediction) {
  Mean out;
  for (std::size_t t = 0; t < sequence.frames(); ++t) {
    for (const std::size_t j : wrists) {
      const std::size_t i = t * sequence.joints + j;
      if (!sequence.has(t, j)) continue;
      out.add(100.0 * (vec3(prediction, i) - vec3(sequence.truth, i)).norm());
    }
  }
  return out.value();
}

std::string person_and_action(const Pair& pair) { return pair.subject + "/" + pair.action; }

// Fitting a pose needs joints on several limbs. The measure PA-MPJPE (evaluate/protocol.h) has the
// same limit of 12 of 18 joints.
constexpr std::size_t least_marked_joints = 12;

/// The indices of the shared joints among the outputs of a layout, in the order of shared_joints.
using Places = std::array<std::optional<std::size_t>, shared_joint_count>;

/// Returns the shared joints of an array [T,J,3], in their order. Missing joints are zero.
std::vector<double> shared_of(const Places& places, std::size_t joints,
                              const std::vector<float>& positions) {
  std::vector<double> out;
  out.reserve(positions.size() / joints * shared_joint_count * 3);
  for (std::size_t row = 0; row + 3 * joints <= positions.size(); row += 3 * joints) {
    for (const auto& j : places) {
      for (std::size_t k = 0; k < 3; ++k) out.push_back(j ? positions[row + 3 * *j + k] : 0.0);
    }
  }
  return out;
}

/// Returns the validity of the shared joints. Missing joints are invalid.
std::vector<std::uint8_t> shared_valid(const Places& places, std::size_t joints,
                                       const std::vector<std::uint8_t>& valid) {
  std::vector<std::uint8_t> out;
  for (std::size_t row = 0; row + joints <= valid.size(); row += joints) {
    for (const auto& j : places) out.push_back(j ? valid[row + *j] : std::uint8_t{0});
  }
  return out;
}

/// Returns some of the shared joints, converted from [T,18,3] m to cm.
std::vector<double> in_centimetres(const std::vector<std::size_t>& places,
                                   const std::vector<double>& positions) {
  std::vector<double> out;
  constexpr std::size_t row = 3 * shared_joint_count;
  for (std::size_t begin = 0; begin + row <= positions.size(); begin += row) {
    for (const std::size_t j : places) {
      for (std::size_t k = 0; k < 3; ++k) out.push_back(100.0 * positions[begin + 3 * j + k]);
    }
  }
  return out;
}

/// Returns the mean position error of each shared joint over its valid frames.
std::array<std::optional<double>, shared_joint_count> joint_errors_cm(const Sequence& sequence,
                                                                      Prediction prediction) {
  std::array<Mean, shared_joint_count> sums{};
  for (std::size_t i = 0; i < sequence.valid.size(); ++i) {
    if (sequence.valid[i] == 0) continue;
    sums[i % shared_joint_count].add(100.0 *
                                     (vec3(prediction, i) - vec3(sequence.truth, i)).norm());
  }
  std::array<std::optional<double>, shared_joint_count> out;
  std::transform(sums.begin(), sums.end(), out.begin(),
                 [](const Mean& sum) { return sum.value(); });
  return out;
}

}  // namespace

/// The true limb lengths are medians over all parts of takes of one person and action. A single
/// part may be too short for a reliable median.
Result<DenoiseMarker> DenoiseMarker::make(const DenoiseLayout& layout,
                                          const std::vector<Pair>& pairs, MarkedIn marked_in) {
  DenoiseMarker out;
  out.marked_in_ = marked_in;
  const auto names = kinect_names(layout.outputs);
  out.places_ = shared_joints_there(names);
  // Bones are indices among the judged joints, so absent joints are not counted.
  std::array<std::size_t, shared_joint_count> own{};
  for (std::size_t j = 0; j < shared_joint_count; ++j) {
    own[j] = out.there_.size();
    if (out.places_[j]) out.there_.push_back(j);
  }
  if (out.there_.size() < least_marked_joints) {
    return Failure(
        Error{"", 0, "at least 12 of the 18 joints that the Kinect and the truth have in common",
              std::to_string(out.there_.size()) + " among " + std::to_string(names.size())});
  }
  for (const SharedBone& bone : limb_bones) {
    if (out.places_[bone.a] && out.places_[bone.b])
      out.bones_.push_back({own[bone.a], own[bone.b]});
  }
  out.joints_ = layout.outputs.size();
  out.rate_hz_ = layout.rate_hz;
  // The sequences are views, so the arrays must stay in place. A deque does not move its elements.
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
  auto truth = shared_of(places_, joints_, pair.truth);
  auto predicted = shared_of(places_, joints_, answer);
  // Both skeletons are moved, so errors of horizontal position and heading do not count.
  if (marked_in_ == MarkedIn::own_root) {
    truth = own_root(truth, shared_joint_count, shared_root);
    predicted = own_root(predicted, shared_joint_count, shared_root);
  }
  const auto valid = shared_valid(places_, joints_, pair.valid);
  const Sequence sequence{shared_joint_count, rate_hz_, truth, valid};
  // The protocol uses all 18 shared joints and ignores invalid ones. Table 9 has no validity, so
  // only the joints that are judged are passed.
  DenoiseMarks out;
  out.protocol = protocol_marks(sequence, predicted, lengths_.at(person_and_action(pair)));
  out.table_nine = table_nine(in_centimetres(there_, truth), in_centimetres(there_, predicted),
                              there_.size(), bones_);
  out.hand_cm = hand_error_cm(sequence, predicted);
  out.joint_cm = joint_errors_cm(sequence, predicted);
  if (const auto lag = lag_s(sequence, predicted)) out.lag_ms = 1000.0 * *lag;
  out.amplitude = amplitude_ratio(sequence, predicted, shared_root.root);
  out.feet = feet_marks(sequence, predicted, shared_feet).value_or(FeetMarks{});
  // A stated spread is one standard deviation per axis. `radius_90` converts it to the radius that
  // should contain 90 % of the errors.
  for (std::size_t i = 0; i < valid.size() && !spread.empty(); ++i) {
    if (valid[i] == 0) continue;
    const std::size_t frame = i / shared_joint_count, shared = i % shared_joint_count;
    out.radii[group_of[shared]].add((vec3(predicted, i) - vec3(truth, i)).norm(),
                                    radius_90 * spread[frame * joints_ + *places_[shared]]);
  }
  return out;
}

}  // namespace kinalign
