// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/followed_clock.h"

#include "kinalign/io/recording_format.h"

#include <algorithm>

namespace kinalign {

void FollowedClock::push(Exchange exchange, std::uint32_t epoch) {
  exchange.boot = life_of(exchange.boot, epoch);
  // In the order in which they came, by microseconds of rounding: later is as true.
  heard_ = exchange.h_rx = std::max(heard_, exchange.h_rx);
  clock_.push(exchange);
  (void)clock_.take_events();  // a screen has no place for them; align finds them again
  now_.reset();
  const auto stamp = clock_.host_from_node(exchange.boot, exchange.n_tx);
  if (!stamp) return;
  now_.emplace();
  now_->host_minus_sender = stamp->time.time_since_epoch() - exchange.n_tx.time_since_epoch();
  if (stamp->certainty == Certainty::certified) {
    now_->half_interval = (*stamp->latest - *stamp->earliest) / 2;
  }
  if (const ClockPiece* piece = clock_.piece()) now_->drift = piece->estimate().slope().mean;
}

}  // namespace kinalign
