// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/nodes/exchanges.h"

#include "tests/about.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;

namespace {

ExchangeOptions on(Link link) {
  ExchangeOptions options;
  options.link.link = link;
  return options;
}

}  // namespace

TEST_CASE("the paper's exchange on the paper's radio takes 33 +- 13 ms") {
  for (const auto seed : fresh_seeds(3)) {
    CAPTURE(seed);
    ExchangeOptions options = on(Link::paper);
    options.length_s = 600.0;
    const auto run = simulate_exchanges(options, seed);
    double n = 0.0, sum = 0.0, squares = 0.0;
    for (const SimulatedFrame& frame : run.frames) {
      if (!frame.confirmed) continue;
      const double d = (*frame.confirmed - frame.replied) / 2.0;
      n += 1.0;
      sum += d;
      squares += d * d;
    }
    const double mean = sum / n, deviation = std::sqrt(squares / n - mean * mean);
    CHECK(mean == about(0.0332, 0.03));
    CHECK(deviation == about(0.0127, 0.04));
  }
}

TEST_CASE("each frame echoes the newest reply that came since the one before, and each but once") {
  for (const auto seed : fresh_seeds(5)) {
    CAPTURE(seed);
    const auto run = simulate_exchanges(on(Link::paper), seed);
    std::vector<int> echoed(run.frames.size(), 0);
    for (std::size_t k = 1; k < run.frames.size(); ++k) {
      const auto& frame = run.frames[k];
      for (const auto& other : run.frames) {
        if (!other.reply_arrival || *other.reply_arrival > frame.sent) continue;
        if (*other.reply_arrival <= run.frames[k - 1].sent) continue;
        REQUIRE(frame.echo);
        CHECK(run.frames[*frame.echo].replied >= other.replied);
      }
      if (frame.echo) CHECK(++echoed[*frame.echo] == 1);
    }
  }
}

TEST_CASE("no stamp of a node implies a packet faster than light") {
  for (const auto seed : fresh_seeds(5)) {
    CAPTURE(seed);
    const auto run = simulate_exchanges(on(Link::congested), seed);
    for (const SimulatedFrame& frame : run.frames) {
      CHECK(std::abs(frame.truth - frame.sent) <= 0.51e-6);
      if (frame.arrival) CHECK(*frame.arrival >= frame.sent + run.floors.up);
      if (frame.reply_arrival) CHECK(*frame.reply_arrival >= frame.replied + run.floors.down);
    }
  }
}

TEST_CASE("a reboot restarts counter and sequence, under another boot id or the same") {
  ExchangeOptions options = on(Link::quiet);
  options.reboots = {{.at = 20.0, .gap = 2.0}, {.at = 40.0, .gap = 0.5, .same_id = true}};
  const auto run = simulate_exchanges(options, 11);
  std::vector<std::size_t> starts;
  for (std::size_t k = 1; k < run.frames.size(); ++k) {
    const auto &frame = run.frames[k], &before = run.frames[k - 1];
    CHECK(!(frame.sent >= 20.0 && frame.sent < 22.0));
    if (frame.sequence == 0) {
      starts.push_back(k);
      CHECK(frame.n_tx_us < 200'000);
    } else {
      CHECK(frame.sequence == before.sequence + 1);
      CHECK(frame.boot_id == before.boot_id);
    }
  }
  REQUIRE(starts.size() == 2);
  CHECK(run.frames[starts[0]].boot_id != run.frames.front().boot_id);
  CHECK(run.frames[starts[1]].boot_id == run.frames[starts[0]].boot_id);
}

TEST_CASE("the same seed gives the same exchanges") {
  const auto one = simulate_exchanges(on(Link::roaming), 5);
  const auto two = simulate_exchanges(on(Link::roaming), 5);
  REQUIRE(one.frames.size() == two.frames.size());
  for (std::size_t k = 0; k < one.frames.size(); ++k) {
    CHECK(one.frames[k].arrival == two.frames[k].arrival);
    CHECK(one.frames[k].n_rx_us == two.frames[k].n_rx_us);
  }
}
