// SPDX-License-Identifier: Apache-2.0
// Converts frames of the Noitom stream to poses. The stream contains no skeleton, so a BVH file
// supplies it.
#pragma once

#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/protocols/noitom/frame.h"

namespace kinalign {

/// The two orders of the 59 joints in Noitom's programs. Joint 10 (counted from 0) distinguishes
/// them.
enum class NoitomHierarchy : std::uint8_t {
  legacy,  // Axis Neuron: the spine has a Spine3, and there is one neck joint
  studio,  // Axis Studio: Neck and Neck1; the shoulders are children of Spine2
  other
};
NoitomHierarchy noitom_hierarchy(const BvhHierarchy& hierarchy);

/// True if all values of a frame are plausible as coordinates or angles.
bool has_sound_values(std::span<const float> row);

/// Reads a frame as a row of the BVH file, with the file's channel order and units.
class NoitomPoser {
 public:
  /// `name`: the file of the hierarchy, for messages. `options.start` is not used, because frames
  /// have their own stamps.
  NoitomPoser(BvhHierarchy hierarchy, const BvhOptions& options, std::string name);

  /// Appends the pose. If the frame begins with a reference, the reference is left out. Fails and
  /// appends nothing if the frame's number of values differs from the number of channels, or if a
  /// value is not a number.
  Result<void> append(const NoitomFrame& frame, Time stamp, ClipFrames& out);

  /// A warning if the hierarchy has neither of Noitom's two orders. Its channels may then not match
  /// the values.
  Findings findings() const;

 private:
  BvhHierarchy hierarchy_;
  BvhPoser poser_;
  std::string name_;
  std::vector<double> row_;
};

}  // namespace kinalign
