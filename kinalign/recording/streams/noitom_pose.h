// SPDX-License-Identifier: Apache-2.0
// From frames of the Noitom stream, which carry no skeleton, to poses of the skeleton of a BVH.
#pragma once

#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/protocols/noitom/frame.h"

namespace kinalign {

/// The two orders of 59 joints that Noitom's programs use; the tenth joint tells them apart.
enum class NoitomHierarchy : std::uint8_t {
  legacy,  // Axis Neuron: Spine3 and one neck
  studio,  // Axis Studio: Neck and Neck1, the shoulders on Spine2
  other
};
NoitomHierarchy noitom_hierarchy(const BvhHierarchy& hierarchy);

/// Whether every value of a frame is a number that can be a coordinate or an angle.
bool has_sound_values(std::span<const float> row);

/// Takes a frame for a row of the BVH: its channels' order, its units.
class NoitomPoser {
 public:
  /// `name` of the header's file, for messages. `options.start` is not used: frames have stamps.
  NoitomPoser(BvhHierarchy hierarchy, const BvhOptions& options, std::string name);

  /// Appends the pose; a reference in front is left out. Fails, and appends nothing, where the row
  /// has not as many values as the header has channels or holds one that is no number.
  Result<void> append(const NoitomFrame& frame, Time stamp, ClipFrames& out);

  /// That the header is neither of Noitom's two: then its channels need not mean what is sent.
  Findings findings() const;

 private:
  BvhHierarchy hierarchy_;
  BvhPoser poser_;
  std::string name_;
  std::vector<double> row_;
};

}  // namespace kinalign
