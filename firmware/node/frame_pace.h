// SPDX-License-Identifier: Apache-2.0
// Decides when the next frame is due.
#pragma once

#include <cstdint>

namespace kinalign {

/// One frame a period, each up to `dither_us` late so that frames do not keep in step with beacons
/// or with another node's. The dither is computed from `seed` and the frame's number, so it differs
/// from node to node, and is the same in each run with the same seed.
class FramePace {
 public:
  FramePace(std::uint32_t period_us, std::uint32_t dither_us, std::uint32_t seed)
      : period_us_(period_us), dither_us_(dither_us), seed_(seed) {}

  bool due(std::uint64_t now_us);
  /// Plans the next frame. False: some frames are already over and are left out, since a burst
  /// after a pause would make a slow radio slower.
  bool advance(std::uint64_t now_us);
  /// The time at which the next frame is due; 0 before the first call of due().
  std::uint64_t next_us() const { return next_us_; }

 private:
  void plan(std::uint64_t grid_us);

  std::uint32_t period_us_, dither_us_, seed_;
  std::uint32_t planned_ = 0;  // number of planned frames
  std::uint64_t grid_us_ = 0, next_us_ = 0;
};

}  // namespace kinalign
