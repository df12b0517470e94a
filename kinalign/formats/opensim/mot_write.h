// SPDX-License-Identifier: Apache-2.0
// Writes a skeleton's motion as an OpenSim .mot file. Layout and losses: docs/formats/opensim.md.
#pragma once

#include "kinalign/core/text_out.h"
#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/motion/clip.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// The head of a file. It contains the number of frames, so that number must be known first.
struct MotHead {
  Skeleton skeleton;
  std::uint64_t frames = 0;
  Time zero{};  // the stamp that becomes time 0
};

/// Writes a .mot file: y up, times to the nanosecond, metres and degrees to six decimals. Each
/// joint has columns such as Hips_rz, Hips_rx, Hips_ry in degrees. Roots also have Hips_tx,
/// Hips_ty, Hips_tz in metres. The angles are the channels of a BVH file of this skeleton, so both
/// files agree. The caller commits `out`, which must exist longer than the writer.
class MotWriter {
 public:
  /// Fails if a joint's name contains a blank, or can't be a cell of tab-separated text.
  static Result<MotWriter> begin(const MotHead& head, TextOut& out);
  Result<void> append(const ClipFrames& frames);
  /// Call this before the file is committed. Fails if the number of frames differs from that in the
  /// head.
  Result<void> finish() const;

 private:
  MotWriter(const MotHead& head, TextOut& out);

  TextOut* out_;
  BvhChannels channels_;
  // [columns] names, and factors that convert a value to the file's unit.
  std::vector<std::string> names_;
  std::vector<double> scales_;
  std::vector<double> values_;  // [T, columns] of a block
  std::uint64_t frames_, written_ = 0;
  Time zero_;
};

}  // namespace kinalign
