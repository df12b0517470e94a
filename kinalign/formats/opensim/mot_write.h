// SPDX-License-Identifier: Apache-2.0
// Writes a skeleton's motion as OpenSim .mot. Layout and losses: docs/formats/opensim.md.
#pragma once

#include "kinalign/core/text_out.h"
#include "kinalign/motion/clip.h"

#include <cstdint>
#include <memory>

namespace kinalign {

enum class MotColumns {
  joint_angles,  // each joint: Hips_rz, Hips_rx, Hips_ry in degrees; roots also Hips_tx, ... in m
  global_positions  // each joint: Hips_X, Hips_Y, Hips_Z in m
};

/// The number of frames stands in the head, so it must be known before the first frame.
struct MotHead {
  Skeleton skeleton;
  MotColumns columns = MotColumns::joint_angles;
  std::uint64_t frames = 0;
  Time zero{};  // the stamp of time 0
};

/// Writes frame after frame: y up, times to the nanosecond, metres and degrees to six decimals. The
/// caller commits `out`, which must outlive the writer.
/// Joint angles are the channels of a BVH of the skeleton, so both files agree.
class MotWriter {
 public:
  /// Fails if a joint's name has a blank or can't stand in a tab-separated cell.
  static Result<MotWriter> begin(const MotHead& head, TextOut& out);
  Result<void> append(const ClipFrames& frames);
  /// Fails if the number of frames differs from the promised one.
  /// Call before the file is committed.
  Result<void> finish() const;

  ~MotWriter();
  MotWriter(MotWriter&&) noexcept;
  MotWriter& operator=(MotWriter&&) noexcept;
  MotWriter(const MotWriter&) = delete;
  MotWriter& operator=(const MotWriter&) = delete;

 private:
  // Columns is hidden so that this header does not include the BVH room.
  class Columns;
  MotWriter(const MotHead& head, TextOut& out, std::unique_ptr<Columns> columns);

  TextOut* out_;
  std::unique_ptr<Columns> columns_;
  std::uint64_t frames_, written_ = 0;
  Time zero_;
};

}  // namespace kinalign
