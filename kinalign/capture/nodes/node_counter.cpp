// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/nodes/node_counter.h"

#include <cmath>
#include <cstdlib>

namespace kinalign {

namespace {

constexpr std::int64_t turn_us = std::int64_t{1} << 32;  // one turn of a 32-bit counter: 71.6 min

/// Limit on the difference between a widened reading and the prediction, us. It covers delays and,
/// after a day of silence, a crystal that is 100 ppm off. Beyond it the reading is taken as 64
/// bits.
constexpr std::int64_t trusted_us = 20'000'000;

}  // namespace

std::int64_t NodeCounter::predicted_us(HostTime h_rx) const {
  return newest_us_ +
         std::chrono::duration_cast<std::chrono::microseconds>(h_rx - newest_arrival_).count();
}

std::int64_t NodeCounter::widened(std::uint64_t counter_us, HostTime h_rx) const {
  const auto read = static_cast<std::int64_t>(counter_us);
  if (!begun_ || read >= turn_us) return read;
  const std::int64_t predicted = predicted_us(h_rx);
  // The whole number of turns that brings the reading nearest to the prediction.
  const auto turns = static_cast<std::int64_t>(
      std::llround(static_cast<double>(predicted - read) / static_cast<double>(turn_us)));
  const std::int64_t nearest = read + turns * turn_us;
  return turns > 0 && std::abs(nearest - predicted) <= trusted_us ? nearest : read;
}

std::int64_t NodeCounter::widened_before(std::uint64_t counter_us, std::int64_t n_tx_us) const {
  const auto read = static_cast<std::int64_t>(counter_us);
  if (read >= turn_us || n_tx_us < turn_us) return read;
  // The reading is put into the turn of n_tx, or into the turn before if it would lie more than
  // half a turn ahead.
  const std::int64_t same_turn = n_tx_us - n_tx_us % turn_us + read;
  return same_turn - n_tx_us > turn_us / 2 ? same_turn - turn_us : same_turn;
}

std::int64_t NodeCounter::ahead_us(std::int64_t n_us, HostTime h_rx) const {
  return begun_ ? n_us - predicted_us(h_rx) : 0;
}

// Late frames must not move the prediction back.
void NodeCounter::take(std::int64_t n_us, HostTime h_rx) {
  if (begun_ && n_us <= newest_us_) return;
  newest_us_ = n_us;
  newest_arrival_ = h_rx;
  begun_ = true;
}

}  // namespace kinalign
