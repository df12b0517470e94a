// SPDX-License-Identifier: Apache-2.0
// The cost of a node's clock: exchanges of ten minutes on each of three links are pushed into a
// live clock, with and without asking for a certified stamp after each; and a whole recording is
// fitted. One item is one exchange (a frame and the echo that it carries); for recordings one item
// is one recording of 60 s.
#include "tools/clock_table/judge.h"

#include "kinalign/clock/offline/offline_clock.h"

#include <benchmark/benchmark.h>

using namespace kinalign;

namespace {

const std::vector<Exchange>& ten_minutes(Link link) {
  static std::array<std::vector<Exchange>, links> kept;
  auto& exchanges = kept[static_cast<std::size_t>(link)];
  if (exchanges.empty()) {
    ExchangeOptions options;
    options.length_s = 600.0;
    options.link.link = link;
    exchanges = exchanges_of(simulate_exchanges(options, 1));
  }
  return exchanges;
}

void count(benchmark::State& state, std::size_t exchanges) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(exchanges));
}

void push(benchmark::State& state) {
  const auto& exchanges = ten_minutes(static_cast<Link>(state.range(0)));
  for (auto _ : state) {
    LiveClock clock;
    for (const Exchange& e : exchanges) clock.push(e);
    benchmark::DoNotOptimize(clock.missed_events());
  }
  count(state, exchanges.size());
}

void push_and_ask(benchmark::State& state) {
  const auto& exchanges = ten_minutes(static_cast<Link>(state.range(0)));
  for (auto _ : state) {
    LiveClock clock;
    for (const Exchange& e : exchanges) {
      clock.push(e);
      benchmark::DoNotOptimize(clock.host_from_node(e.boot, e.n_tx));
    }
  }
  count(state, exchanges.size());
}

/// One recording, simulated and judged live and offline: a table is made of a thousand of these.
void recording(benchmark::State& state) {
  ExchangeOptions options;
  options.link.link = static_cast<Link>(state.range(0));
  std::uint64_t seed = 1;
  for (auto _ : state) {
    const auto run = simulate_exchanges(options, seed++);
    benchmark::DoNotOptimize(judge_live(run).stamps.size());
    benchmark::DoNotOptimize(judge_offline(run).stamps.size());
  }
  state.SetItemsProcessed(state.iterations());
}

void each_link(benchmark::internal::Benchmark* bench) {
  for (const Link link : {Link::quiet, Link::paper, Link::congested}) {
    bench->Arg(static_cast<int>(link));
  }
}

}  // namespace

BENCHMARK(push)->Name("clock_push")->Apply(each_link);
BENCHMARK(push_and_ask)->Name("clock_push_and_ask")->Apply(each_link);
BENCHMARK(recording)->Name("clock_recording")->Apply(each_link);
