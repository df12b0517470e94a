// SPDX-License-Identifier: Apache-2.0
// Collects the latencies of a live run and computes percentiles.
#pragma once

#include "kinalign/wire/time.h"

#include <cstddef>
#include <string>
#include <vector>

namespace kinalign {

/// The latencies of frames, ms. `after_arrival` is the time from the arrival of the newest message
/// that the answer needed to the answer. `behind_motion` is the time from the frame's stamp to the
/// answer.
class LiveLatency {
 public:
  static constexpr std::size_t most = 1'000'000;  // later frames are not counted

  void add(Duration after_arrival, Duration behind_motion);
  std::size_t frames() const { return after_arrival_.size(); }
  /// A percentile: the value below which the fraction `share` of the frames lies; 0 without frames.
  /// Only the newest `newest` frames are counted.
  double after_arrival_ms(double share, std::size_t newest = most) const;
  double behind_motion_ms(double share, std::size_t newest = most) const;

 private:
  std::vector<float> after_arrival_, behind_motion_;
};

}  // namespace kinalign
