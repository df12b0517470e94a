// SPDX-License-Identifier: Apache-2.0
// Writes a skeleton's motion as OpenSim .mot. Layout and losses: docs/formats/opensim.md.
#pragma once

#include "kinalign/core/text_out.h"
#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/motion/clip.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// The number of frames stands in the head, so it must be known before the first frame.
struct MotHead {
  Skeleton skeleton;
  std::uint64_t frames = 0;
  Time zero{};  // the stamp of time 0
};

/// Writes frame after frame: y up, times to the nanosecond, metres and degrees to six decimals. The
/// caller commits `out`, which must outlive the writer. Columns: each joint Hips_rz, Hips_rx,
/// Hips_ry in degrees; roots also Hips_tx, Hips_ty, Hips_tz in metres.
/// Joint angles are the channels of a BVH of the skeleton, so both files agree.
class MotWriter {
 public:
  /// Fails if a joint's name has a blank or can't stand in a tab-separated cell.
  static Result<MotWriter> begin(const MotHead& head, TextOut& out);
  Result<void> append(const ClipFrames& frames);
  /// Fails if the number of frames differs from the promised one.
  /// Call before the file is committed.
  Result<void> finish() const;

 private:
  MotWriter(const MotHead& head, TextOut& out);

  TextOut* out_;
  BvhChannels channels_;
  // [columns] names, and factors from the values' unit to the file's.
  std::vector<std::string> names_;
  std::vector<double> scales_;
  std::vector<double> values_;  // [T, columns] of a block
  std::uint64_t frames_, written_ = 0;
  Time zero_;
};

}  // namespace kinalign
