// SPDX-License-Identifier: Apache-2.0
// The latencies of a verb's live answers. Pure functions.
#pragma once

#include "kinalign/wire/time.h"

#include <cstddef>
#include <string>
#include <vector>

namespace kinalign {

/// The latencies of frames, ms. `after_arrival`: from the arrival of the newest message that an
/// answer needed to the answer. `behind_motion`: from the stamp of the frame to the answer.
class LiveLatency {
 public:
  static constexpr std::size_t most = 1'000'000;  // frames; later ones are not counted

  void add(Duration after_arrival, Duration behind_motion);
  std::size_t frames() const { return after_arrival_.size(); }
  /// The value below which that share of the frames lies; 0 without frames. `newest`: counts only
  /// this number of newest frames.
  double after_arrival_ms(double share, std::size_t newest = most) const;
  double behind_motion_ms(double share, std::size_t newest = most) const;

 private:
  std::vector<float> after_arrival_, behind_motion_;
};

}  // namespace kinalign
