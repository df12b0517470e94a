// SPDX-License-Identifier: Apache-2.0
// A node's counter in us, extended to 64 bits. A node may send only the low 32 bits. Such a reading
// is extended ("unwrapped") to the value nearest to the prediction from the host's clock.
#pragma once

#include "kinalign/wire/counter.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <cstdlib>

namespace kinalign {

/// The prediction is the newest reading plus the time since then on the host's clock. The error of
/// the node's crystal is small compared with the 71 minutes after which 32 bits wrap.
class NodeCounter {
 public:
  /// Unwraps a reading in us that arrived at h_rx. Does not change the state.
  std::int64_t unwrap(std::uint64_t counter_us, HostTime h_rx) const {
    const auto read = static_cast<std::int64_t>(counter_us);
    if (!begun_ || read >= turn_us) return read;
    const std::int64_t nearest = unwrapped(counter_us, 32, predicted_us(h_rx));
    return nearest > read && std::abs(ahead_us(nearest, h_rx)) <= trusted_us ? nearest : read;
  }
  /// Unwraps a reading taken at or before `n_tx_us`, which is already unwrapped.
  static std::int64_t unwrap_before(std::uint64_t counter_us, std::int64_t n_tx_us) {
    const auto read = static_cast<std::int64_t>(counter_us);
    return read >= turn_us || n_tx_us < turn_us ? read : unwrapped(counter_us, 32, n_tx_us);
  }

  /// n minus the predicted reading, us. Positive: n is ahead. 0 before the first reading.
  std::int64_t ahead_us(std::int64_t n_us, HostTime h_rx) const {
    return begun_ ? n_us - predicted_us(h_rx) : 0;
  }
  /// The newest reading minus n, us. Negative: n is newer than the newest reading.
  std::int64_t behind_us(std::int64_t n_us) const { return begun_ ? newest_us_ - n_us : 0; }

  /// Stores an unwrapped reading if it is the newest. Late frames must not move the prediction
  /// back.
  void take(std::int64_t n_us, HostTime h_rx) {
    if (begun_ && n_us <= newest_us_) return;
    newest_us_ = n_us;
    newest_arrival_ = h_rx;
    begun_ = true;
  }

 private:
  static constexpr std::int64_t turn_us = std::int64_t{1} << 32;  // 32 bits wrap after 71.6 min
  /// Limit on the difference between an unwrapped reading and the prediction, us. It allows for
  /// delays and, after a day of silence, for a crystal that is 100 ppm off. If the difference is
  /// greater, the reading is a 64-bit value.
  static constexpr std::int64_t trusted_us = 20'000'000;

  std::int64_t predicted_us(HostTime h_rx) const {
    const auto since = h_rx - newest_arrival_;
    return newest_us_ + std::chrono::duration_cast<std::chrono::microseconds>(since).count();
  }

  std::int64_t newest_us_ = 0;
  HostTime newest_arrival_{};  // arrival of the newest reading
  bool begun_ = false;
};

}  // namespace kinalign
