// SPDX-License-Identifier: Apache-2.0
// Simulates recordings in whose middle a counter steps, and looks for certified stamps that are
// wrong. Prints a line of JSON for each such recording, with all exchanges that the host received,
// and one line for each link and size of the step. steps.py reads them and asks whether any method
// could have noticed the step.
//
//   kinalign_clock_steps MINUTES SEEDS FIRST_SEED LINKS TIMES...
//
// TIMES: the size of the step, as a multiple of both least delays together. Every other seed steps
// back, at any second of the windows by which floors are judged.
#include "tools/clock_table/judge.h"

#include "kinalign/core/numbers.h"

#include <fmt/format.h>

#include <cstdio>
#include <iterator>
#include <string>
#include <vector>

using namespace kinalign;

namespace {

struct Wanted {
  double minutes = 0.0;
  std::uint64_t seeds = 0, first = 0;
};

/// Bounds as [node, host], in seconds since the readings of the first frame.
std::string bounds_json(const std::vector<Exchange>& exchanges) {
  const NodeTime node = exchanges.front().n_tx;
  const HostTime host = exchanges.front().h_rx;
  std::string up, down;
  for (const Exchange& e : exchanges) {
    fmt::format_to(std::back_inserter(up), "{}[{:.9f},{:.9f}]", up.empty() ? "" : ",",
                   seconds(e.n_tx - node), seconds(e.h_rx - host));
    if (!e.echo) continue;
    fmt::format_to(std::back_inserter(down), "{}[{:.9f},{:.9f}]", down.empty() ? "" : ",",
                   seconds(e.echo->n_rx - node), seconds(e.echo->h_tx - host));
  }
  return fmt::format(R"("up":[{}],"down":[{}])", up, down);
}

void judge(Link link, double times, const Wanted& wanted) {
  std::uint64_t live = 0, offline = 0;
  for (std::uint64_t seed = wanted.first; seed < wanted.first + wanted.seeds; ++seed) {
    const Floors least = floors(link, seed);
    ExchangeOptions options;
    options.length_s = 60.0 * wanted.minutes;
    options.link.link = link;
    const double into_window = static_cast<double>(seed / 2 % 10);
    options.steps = {{.at = options.length_s / 2.0 + into_window,
                      .by = (seed % 2 == 0 ? 1.0 : -1.0) * times * (least.up + least.down)}};
    const SimulatedExchanges exchanges = simulate_exchanges(options, seed);
    const auto of_live = judge_live(exchanges).lies(), of_offline = judge_offline(exchanges).lies();
    live += of_live > 0 ? 1 : 0;
    offline += of_offline > 0 ? 1 : 0;
    if (of_live + of_offline == 0) continue;
    fmt::print(R"({{"link":"{}","times":{},"seed":{},"wrong_live":{},"wrong_offline":{},{}}})"
               "\n",
               letter(link), times, seed, of_live, of_offline,
               bounds_json(exchanges_of(exchanges)));
  }
  fmt::print(R"({{"link":"{}","times":{},"runs":{},"live":{},"offline":{}}})"
             "\n",
             letter(link), times, wanted.seeds, live, offline);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  std::vector<double> numbers;  // all arguments but the letters of the links
  for (const std::string& word : words) {
    double value = 0.0;
    if (parse_number(word, value) && value > 0.0) numbers.push_back(value);
  }
  const bool letters =
      words.size() > 3 && words[3].find_first_not_of("ABCDEFG") == std::string::npos;
  if (!letters || numbers.size() < 4 || numbers.size() + 1 != words.size()) {
    fmt::print(stderr, "usage: kinalign_clock_steps MINUTES SEEDS FIRST_SEED LINKS TIMES...\n");
    return 2;
  }
  const Wanted wanted{numbers[0], static_cast<std::uint64_t>(numbers[1]),
                      static_cast<std::uint64_t>(numbers[2])};
  for (const char link : words[3]) {
    for (std::size_t i = 3; i < numbers.size(); ++i) {
      judge(static_cast<Link>(link - 'A'), numbers[i], wanted);
    }
  }
}
