// SPDX-License-Identifier: Apache-2.0
// Converts frames of the Noitom stream, which contain no skeleton, to poses of the skeleton of a
// BVH.
#pragma once

#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/protocols/noitom/frame.h"

namespace kinalign {

/// The two orders of 59 joints in Noitom's programs. Joint 10, counted from 0, distinguishes them.
enum class NoitomHierarchy : std::uint8_t {
  legacy,  // Axis Neuron: Spine3 and one neck
  studio,  // Axis Studio: Neck and Neck1, the shoulders on Spine2
  other
};
NoitomHierarchy noitom_hierarchy(const BvhHierarchy& hierarchy);

/// Returns whether all values of a frame are plausible as coordinates or angles.
bool has_sound_values(std::span<const float> row);

/// Uses a frame as a row of the BVH, with its channel order and units.
class NoitomPoser {
 public:
  /// `name`: the header's file, used in messages. `options.start` is not used, since frames have
  /// stamps.
  NoitomPoser(BvhHierarchy hierarchy, const BvhOptions& options, std::string name);

  /// Appends the pose. A reference in front of the pose is left out. Fails and appends nothing if
  /// the number of values differs from the header's number of channels, or if a value is not a
  /// number.
  Result<void> append(const NoitomFrame& frame, Time stamp, ClipFrames& out);

  /// A warning if the header has neither of Noitom's two orders, since its channels may then not
  /// match the values.
  Findings findings() const;

 private:
  BvhHierarchy hierarchy_;
  BvhPoser poser_;
  std::string name_;
  std::vector<double> row_;
};

}  // namespace kinalign
