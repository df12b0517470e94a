// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/own_rows.h"

#include "kinalign/motion/kinematics.h"

#include <algorithm>

namespace kinalign {

void fill_positions(const Skeleton& skeleton, ClipRows& rows, std::size_t count) {
  const std::size_t width = skeleton.joints() * 3;
  ClipFrames frames;
  // forward_kinematics() takes frames. The arrays are swapped into `frames` and back, so nothing is
  // copied. Only the number of stamps matters, not their values.
  frames.stamps.resize(count);
  frames.local_positions.swap(rows.local_positions);
  frames.local_rotations.swap(rows.local_rotations);
  rows.positions.resize(count * width);
  forward_kinematics(skeleton, frames, rows.positions);
  rows.local_positions.swap(frames.local_positions);
  rows.local_rotations.swap(frames.local_rotations);
  // Invalid rows contain rotations of zeros, which give no meaningful positions.
  for (std::size_t r = 0; r < rows.valid.size(); ++r) {
    if (rows.valid[r] == 0) std::fill_n(&rows.positions[r * width], width, 0.0);
  }
}

ClipRows own_rows(const Skeleton& skeleton, ClipFrames frames) {
  ClipRows rows;
  rows.local_positions = std::move(frames.local_positions);
  rows.local_rotations = std::move(frames.local_rotations);
  fill_positions(skeleton, rows, frames.size());
  return rows;
}

PointRows own_rows(PointFrames frames) {
  PointRows rows;
  rows.positions = std::move(frames.positions);
  for (const Tracking state : frames.state) rows.valid.push_back(state != Tracking::missing);
  rows.state = std::move(frames.state);
  return rows;
}

}  // namespace kinalign
