// SPDX-License-Identifier: Apache-2.0
// OpenSim .mot of a skeleton's motion. Layout, and what is lost: docs/formats/opensim.md.
#pragma once

#include "kinalign/core/text_out.h"
#include "kinalign/motion/clip.h"

#include <cstdint>
#include <memory>

namespace kinalign {

enum class MotColumns {
  joint_angles,  // of each joint Hips_rz, Hips_rx, Hips_ry in degrees; of roots Hips_tx, ... in m
  global_positions  // of each joint Hips_X, Hips_Y, Hips_Z in m
};

struct MotHead {
  Skeleton skeleton;
  MotColumns columns = MotColumns::joint_angles;
  std::uint64_t frames = 0;
  Time zero{};  // the stamp of time 0
};

/// Writes frame after frame: y up, seconds to the nanosecond, micrometres and millionths of a
/// degree. The caller commits `out`, which must outlive the writer.
class MotWriter {
 public:
  /// Fails where a joint's name can't stand in a tab-separated cell or has a blank.
  static Result<MotWriter> begin(const MotHead& head, TextOut& out);
  Result<void> append(const ClipFrames& frames);
  /// Fails where other than the promised frames were given.
  Result<void> finish() const;

  ~MotWriter();
  MotWriter(MotWriter&&) noexcept;
  MotWriter& operator=(MotWriter&&) noexcept;
  MotWriter(const MotWriter&) = delete;
  MotWriter& operator=(const MotWriter&) = delete;

 private:
  class Columns;
  MotWriter(const MotHead& head, TextOut& out, std::unique_ptr<Columns> columns);

  TextOut* out_;
  std::unique_ptr<Columns> columns_;
  std::uint64_t frames_, written_ = 0;
  Time zero_;
};

}  // namespace kinalign
