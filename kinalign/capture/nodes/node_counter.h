// SPDX-License-Identifier: Apache-2.0
// A node's counter in us, as 64 bits. A node may send only the low 32 bits. Such a reading is
// widened to the value nearest to the value predicted from the host's clock.
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>

namespace kinalign {

/// The highest accepted reading, us: 142 years. A higher one is wrong and would overflow in ns.
inline constexpr std::uint64_t most_counter_us = std::uint64_t{1} << 52;

constexpr NodeTime node_time(std::int64_t us) { return NodeTime{std::chrono::microseconds(us)}; }

/// The prediction continues from the newest reading with the host's clock. A crystal's error is
/// small against a turn of 71 minutes.
class NodeCounter {
 public:
  /// Widens a reading that arrived at h_rx, us. Does not change the state.
  std::int64_t widened(std::uint64_t counter_us, HostTime h_rx) const;
  /// Widens a reading taken at or before `n_tx_us`, which is already widened.
  std::int64_t widened_before(std::uint64_t counter_us, std::int64_t n_tx_us) const;

  /// n minus the predicted counter, us. Positive: the counter is ahead. 0 before the first reading.
  std::int64_t ahead_us(std::int64_t n_us, HostTime h_rx) const;
  /// The newest reading minus n, us. Negative: n is newer.
  std::int64_t behind_us(std::int64_t n_us) const { return begun_ ? newest_us_ - n_us : 0; }

  /// Stores a widened reading if it is the newest.
  void take(std::int64_t n_us, HostTime h_rx);

 private:
  std::int64_t predicted_us(HostTime h_rx) const;

  std::int64_t newest_us_ = 0;
  HostTime newest_arrival_{};  // arrival of the newest reading
  bool begun_ = false;
};

}  // namespace kinalign
