// SPDX-License-Identifier: Apache-2.0
// The tables of docs/clock_figures.md, and the bars for them; see --help.
#include "tools/clock_table/arguments.h"
#include "tools/clock_table/markdown.h"
#include "tools/clock_table/print.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <random>

namespace kinalign {

namespace {

constexpr int done = 0, findings = 1, wrong_use = 2;

bool no_certified_stamp_is_wrong(const std::vector<LinkFigures>& tables) {
  return std::all_of(tables.begin(), tables.end(), [](const LinkFigures& table) {
    return table.live.wrong == 0 && table.offline.wrong == 0;
  });
}

/// Tables of one set, or its bars.
int show_set(const Wanted& wanted, std::uint64_t first) {
  const RunSet set{wanted.minutes, static_cast<std::uint64_t>(wanted.seeds), first, wanted.bursts};
  std::vector<LinkRun> runs;
  for (const char link : wanted.links) runs.push_back({static_cast<Link>(link - 'A'), set});
  const auto tables = measure(runs);
  bool fine = no_certified_stamp_is_wrong(tables);
  if (wanted.output == Wanted::Output::bars) {
    const auto judged = verdicts(set, tables);
    print_verdicts(set, judged);
    fine = fine && std::all_of(judged.begin(), judged.end(),
                               [](const Verdict& verdict) { return verdict.met(); });
  } else {
    print_tables(set, tables);
  }
  return fine ? done : findings;
}

int show_page(std::uint64_t first) {
  const PageFigures page = measure(page_sets(first));
  fmt::print("{}", markdown(page));
  bool fine = true;
  for (const auto* tables : {&page.minute, &page.ten_minutes, &page.hour, &page.bursts}) {
    fine = fine && no_certified_stamp_is_wrong(*tables);
  }
  return fine ? done : findings;
}

int run(const std::vector<std::string>& words) {
  const auto wanted = wanted_from(words);
  if (!wanted) {
    fmt::print(stderr, "kinalign_clock_table: {}; --help shows examples\n",
               to_string(wanted.error()));
    return wrong_use;
  }
  const auto first = static_cast<std::uint64_t>(wanted->first.value_or(std::random_device{}()));
  switch (wanted->output) {
    case Wanted::Output::help:
      fmt::print("{}", help_page);
      return done;
    case Wanted::Output::markdown:
      return show_page(first);
    case Wanted::Output::tables:
    case Wanted::Output::bars:
      break;
  }
  return show_set(*wanted, first);
}

}  // namespace

}  // namespace kinalign

int main(int argc, char** argv) { return kinalign::run({argv + 1, argv + argc}); }
