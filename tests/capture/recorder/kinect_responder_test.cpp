// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/kinect_responder.h"

#include "tests/seeds.h"

#include "kinalign/clock/live/live_clock.h"

#include <doctest/doctest.h>

#include <random>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

HostAddress host(std::uint8_t last) {
  const std::array<std::uint8_t, 4> bytes{192, 168, 7, last};
  return mapped_ipv4(bytes);
}

HostTime at(Duration t) { return HostTime{t}; }

/// A sender whose ticks began at 0 when the host's clock showed `begun`.
struct Sender {
  std::uint32_t session = 0x5eedf00d;
  HostTime begun{100s};
  std::uint32_t pings = 0;
  std::optional<KinectEcho> echo{};

  std::int64_t ticks(HostTime t) const { return (t - begun).count() / 100; }
  KinectPing ping(HostTime sent) { return {{2, session, pings++}, ticks(sent), echo}; }
  void hear(const KinectPong& pong, HostTime t) {
    echo = KinectEcho{pong.pong_sequence, pong.nonce, ticks(t)};
  }
};

}  // namespace

TEST_CASE("a ping is answered with its own numbers, and its echo gives what the host remembers") {
  KinectResponder responder({});
  Sender sender;
  const auto first = responder.receive(sender.ping(at(101s)), host(5), at(101s + 2ms));
  REQUIRE(first);
  CHECK(first->boot == 0x5eedf00dU);  // the session
  CHECK(first->n_tx == NodeTime{1s});
  CHECK(first->h_rx == at(101s + 2ms));
  CHECK(!first->echo);
  const auto pong = responder.answer(at(101s + 3ms));
  REQUIRE(pong);
  CHECK(pong->origin == KinectOrigin{2, 0x5eedf00d, 0});
  CHECK(pong->pong_sequence == 0);
  CHECK(!responder.answer(at(101s + 3ms)));  // once
  sender.hear(*pong, at(101s + 5ms));
  const auto second = responder.receive(sender.ping(at(101200ms)), host(5), at(101202ms));
  REQUIRE(second);
  REQUIRE(second->echo);
  CHECK(second->echo->n_rx == NodeTime{1005ms});
  CHECK(second->echo->h_tx == at(101s + 3ms));
}

TEST_CASE("an echo of a pong that was never sent, or that arrived after the ping left, is none") {
  KinectResponder responder({});
  Sender sender;
  REQUIRE(responder.receive(sender.ping(at(101s)), host(5), at(101s)));
  const KinectPong pong = *responder.answer(at(101s));
  KinectPong wrong = pong;
  ++wrong.nonce;
  sender.hear(wrong, at(101s));
  CHECK(!responder.receive(sender.ping(at(102s)), host(5), at(102s))->echo);
  sender.hear(pong, at(104s));
  CHECK(!responder.receive(sender.ping(at(103s)), host(5), at(103s))->echo);
  sender.session = 1;  // another run of the sender
  sender.hear(pong, at(101s));
  CHECK(!responder.receive(sender.ping(at(105s)), host(5), at(105s))->echo);
}

TEST_CASE("a sender's clock is certified by its pings, and the interval holds the truth") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::exponential_distribution<double> delay(1 / 2e-3);
    const auto way = [&] { return Duration{200'000 + std::int64_t(1e9 * delay(random))}; };
    KinectResponder responder({});
    LiveClock clock;
    Sender sender;
    HostTime now{101s};
    for (int i = 0; i < 50; ++i, now += 200ms) {
      const KinectPing ping = sender.ping(now);
      const HostTime h_rx = now + way();
      const auto exchange = responder.receive(ping, host(5), h_rx);
      REQUIRE(exchange);
      clock.push(*exchange);
      const HostTime h_tx = h_rx + 20us;
      if (const auto pong = responder.answer(h_tx)) sender.hear(*pong, h_tx + way());
      const auto stamp = clock.host_from_node(exchange->boot, exchange->n_tx);
      if (i < 10) continue;
      REQUIRE(stamp);
      CHECK(stamp->certainty == Certainty::certified);
      CHECK(*stamp->earliest <= now + 100ns);  // a tick
      CHECK(now <= *stamp->latest + 100ns);
    }
  }
}

TEST_CASE("a flood of pings is answered 30 times a second, and one of sessions hardly") {
  KinectResponder responder({});
  Sender sender;
  std::uint64_t pongs = 0;
  for (int i = 0; i < 3000; ++i) {
    const HostTime now = at(101s + i * 1ms);
    CHECK(responder.receive(sender.ping(now), host(5), now));
    if (responder.answer(now)) ++pongs;
  }
  CHECK(pongs <= 3 * 30 + 1);
  CHECK(pongs > 60);
  for (std::uint32_t session = 1; session <= 1000; ++session) {
    Sender stranger{session};
    const HostTime now = at(104s + session * 1ms);
    CHECK(responder.receive(stranger.ping(now), host(66), now).has_value() == (session <= 8));
    CHECK(responder.answer(now).has_value() == (session <= 8));
  }
  // A known sender is still accepted.
  CHECK(responder.receive(sender.ping(at(106s)), host(5), at(106s)));
}

TEST_CASE("32 sessions are kept, a further one takes the place of one that was silent a minute") {
  KinectResponder responder({});
  const auto begins = [&](std::uint32_t session, HostTime now) {
    Sender sender{session};
    return responder.receive(sender.ping(now), host(static_cast<std::uint8_t>(session)), now)
        .has_value();
  };
  for (std::uint32_t session = 1; session <= 32; ++session) CHECK(begins(session, at(100s)));
  CHECK(!begins(33, at(160s)));
  CHECK(begins(33, at(161s)));
}
