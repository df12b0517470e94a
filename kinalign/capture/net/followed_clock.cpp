// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/followed_clock.h"

#include "kinalign/recording/format.h"

#include <algorithm>

namespace kinalign {

SenderClock sender_clock(const ClockStamp& stamp, NodeTime n, double drift) {
  SenderClock clock{stamp.time.time_since_epoch() - n.time_since_epoch(), std::nullopt, drift};
  if (stamp.certainty == Certainty::certified) {
    clock.half_interval = (*stamp.latest - *stamp.earliest) / 2;
  }
  return clock;
}

void FollowedClock::push(Exchange exchange, std::uint32_t epoch) {
  // After a new epoch of the host's time axis, the device's boot gets a new number. Exchanges from
  // before the epoch are then ignored.
  exchange.boot = boot_in_epoch(exchange.boot, epoch);
  // Rounding may put an arrival microseconds before the previous arrival. The stamp is then raised
  // to the previous one. A stamp that is too late still gives a correct clock bound.
  newest_arrival_ = exchange.h_rx = std::max(newest_arrival_, exchange.h_rx);
  clock_->push(exchange);
  (void)clock_->take_events();  // events are not displayed; align computes them again
  now_.reset();
  const auto stamp = clock_->host_from_node(exchange.boot, exchange.n_tx);
  if (!stamp) return;
  const ClockPiece* piece = clock_->piece();
  now_ = sender_clock(*stamp, exchange.n_tx, piece ? piece->estimate().slope().mean : 0.0);
}

}  // namespace kinalign
