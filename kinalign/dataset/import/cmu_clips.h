// SPDX-License-Identifier: Apache-2.0
// Clips of CMU's motion capture database, packed into an NPZ. The pack has angles as second
// differences, and one skeleton for each person. Layout: docs/dataset_import.md.
#pragma once

#include "kinalign/formats/archive/archive.h"
#include "kinalign/motion/clip.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// One clip in the pack: a range of frames of one person.
struct PackedClip {
  std::string person, take, label, text;  // "13", "13_29", "climb", CMU's description
  std::string same;      // the same clip in another pack: "daz_05:06_01"; empty: none
  std::size_t body = 0;  // index of the person's skeleton
  std::size_t begin = 0, frames = 0;
};

/// A pack in memory, as whole numbers. clip() computes the values of one clip.
class PackedClips {
 public:
  /// Fails if an array is missing, has another shape, or has impossible values.
  static Result<PackedClips> read(const ArchiveBytes& bytes);

  const std::vector<PackedClip>& clips() const { return clips_; }
  double frame_seconds() const { return frame_seconds_; }
  // `packed` must be one of clips().
  Clip clip(const PackedClip& packed) const;

 private:
  std::vector<Skeleton> skeletons_;      // one for each person
  std::vector<std::vector<Quat>> axes_;  // [person][joint]: the joint's axes in the parent's space
  std::vector<PackedClip> clips_;
  std::vector<std::int16_t> values_;  // [C,F]: root x, y, z in 0.5 mm; then for each joint the
                                      // angles x, y, z in 0.015 degrees
  std::size_t frames_ = 0;
  double frame_seconds_ = 1.0 / 60.0;
};

}  // namespace kinalign
