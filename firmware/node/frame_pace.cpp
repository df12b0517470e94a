// SPDX-License-Identifier: Apache-2.0
#include "firmware/node/frame_pace.h"

namespace kinalign {

namespace {

/// Bits that look random: the last step of MurmurHash3 (A. Appleby, public domain).
std::uint32_t mixed(std::uint32_t bits) {
  bits = (bits ^ bits >> 16) * 0x85ebca6bU;
  bits = (bits ^ bits >> 13) * 0xc2b2ae35U;
  return bits ^ bits >> 16;
}

}  // namespace

void FramePace::plan(std::uint64_t grid_us) {
  grid_us_ = grid_us;
  ++planned_;
  const std::uint64_t share = mixed(seed_ ^ mixed(planned_));
  next_us_ = grid_us + (share * dither_us_ >> 32);
}

bool FramePace::due(std::uint64_t now_us) {
  const bool first = planned_ == 0;
  const bool counter_went_back = grid_us_ > now_us && grid_us_ - now_us > 2ULL * period_us_;
  if (first || counter_went_back) plan(now_us + period_us_ / 2);
  return now_us >= next_us_;
}

bool FramePace::advance(std::uint64_t now_us) {
  const std::uint64_t late = now_us - grid_us_;  // the frame is due, so this is at least 0
  const std::uint64_t over = late / period_us_;
  plan(grid_us_ + (over + 1) * period_us_);
  return over == 0;
}

}  // namespace kinalign
