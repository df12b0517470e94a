// SPDX-License-Identifier: Apache-2.0
// A node's counter, us, as 64 bits though the node may send the low 32 of it: those are widened to
// the reading that lies nearest to what the host's clock foretells.
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>

namespace kinalign {

/// The highest reading there is, 142 years: beyond it a node lies, and ns would overflow.
inline constexpr std::uint64_t most_counter_us = std::uint64_t{1} << 52;

constexpr NodeTime node_time(std::int64_t us) { return NodeTime{std::chrono::microseconds(us)}; }

class NodeCounter {
 public:
  /// What a reading at h_rx stands for, us; changes nothing.
  std::int64_t widened(std::uint64_t counter_us, HostTime h_rx) const;
  /// The same for a reading that was taken at or before `n_tx_us`, a widened one.
  std::int64_t widened_before(std::uint64_t counter_us, std::int64_t n_tx_us) const;

  /// n - what was foretold, us; positive: the counter is ahead. 0 before the first.
  std::int64_t ahead_us(std::int64_t n_us, HostTime h_rx) const;
  /// How far n lies behind the newest, us; negative: it is newer.
  std::int64_t behind_us(std::int64_t n_us) const { return begun_ ? newest_us_ - n_us : 0; }

  void take(std::int64_t n_us, HostTime h_rx);

 private:
  std::int64_t foretold_us(HostTime h_rx) const;

  std::int64_t newest_us_ = 0;
  HostTime heard_{};  // when the newest came
  bool begun_ = false;
};

}  // namespace kinalign
