// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/followed_clock.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

constexpr double ppm_fast = 20.0;  // by which the sender's clock is fast, ppm
constexpr Duration began{5s};      // the sender's clock at 1000 s of the host's

/// The reading of the sender's clock at a moment of the host's clock.
NodeTime sender_at(HostTime host) {
  const double since = seconds(host - HostTime{1000s});
  return NodeTime{began + Duration{static_cast<std::int64_t>(since * (1e9 + 1e3 * ppm_fast))}};
}

/// One ping a second, with the echo of the pong before; each way takes 2 ms.
Exchange nth_exchange(int k) {
  const HostTime sent{1000s + k * 1s};
  Exchange exchange;
  exchange.boot = 77;
  exchange.n_tx = sender_at(sent);
  exchange.h_rx = sent + 2ms;
  if (k > 0) {
    const HostTime pong = sent - 1s + 3ms;
    exchange.echo = Exchange::Echo{sender_at(pong + 2ms), pong};
  }
  return exchange;
}

}  // namespace

TEST_CASE("a sender's clock is known within its round trip, and with its drift, after some pings") {
  FollowedClock clock;
  for (int k = 0; k < 60; ++k) clock.push(nth_exchange(k), 1);
  REQUIRE(clock.now());
  REQUIRE(clock.now()->half_interval);
  const HostTime last{1059s};
  const Duration truth = last.time_since_epoch() - sender_at(last).time_since_epoch();
  CHECK(std::chrono::abs(clock.now()->host_minus_sender - truth) <= *clock.now()->half_interval);
  CHECK(*clock.now()->half_interval <= 3ms);
  CHECK(clock.now()->drift == doctest::Approx(-1e-6 * ppm_fast).epsilon(0.2));
}

TEST_CASE("one ping gives no interval, and after suspend the clock is learnt again") {
  FollowedClock clock;
  clock.push(nth_exchange(0), 1);
  CHECK((!clock.now() || !clock.now()->half_interval));
  for (int k = 1; k < 10; ++k) clock.push(nth_exchange(k), 1);
  REQUIRE(clock.now());
  CHECK(clock.now()->half_interval);
  Exchange first = nth_exchange(10);
  first.echo.reset();
  clock.push(first, 2);
  CHECK((!clock.now() || !clock.now()->half_interval));
}
