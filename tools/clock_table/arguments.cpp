// SPDX-License-Identifier: Apache-2.0
#include "tools/clock_table/arguments.h"

#include "apps/cli/command_line.h"
#include "apps/cli/field_text.h"
#include "tools/clock_table/promises.h"

#include <fmt/format.h>

#include <algorithm>

namespace kinalign {

namespace {

/// Two switches from which the table makes one choice (Wanted::output).
struct Switches {
  bool bars = false, markdown = false;
};

// A recording has at least half a minute: live errors count from 10 s on, and starts are watched
// for 30 s.
Usage describe(Wanted& o, Switches& switches) {
  Usage usage;
  usage.flags = {{"minutes", "length of a recording", &o.minutes, 0.5, 600.0},
                 {"seeds", "recordings of each link", &o.seeds, 1.0, 10'000.0},
                 {"first", "the first seed", &o.first, 0.0, 9e15},
                 {"links", "by their letters", &o.links},
                 {"bursts", "half of all packets lost, 2 s at a time", &o.bursts},
                 {"bars", "hold the figures against the promises", &switches.bars},
                 {"markdown", "the tables of docs/clock_figures.md", &switches.markdown}};
  return usage;
}

Failure wrong(std::string flag, std::string expected, std::string found) {
  return Failure(Error{std::move(flag), 0, std::move(expected), std::move(found)});
}

Result<void> check_links(const std::string& text) {
  const std::string all = Wanted{}.links;
  std::string sorted = text;
  std::sort(sorted.begin(), sorted.end());
  const bool once = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
  if (text.empty() || !once || text.find_first_not_of(all) != std::string::npos) {
    return wrong("--links", "letters of " + all + ", each once", shown(text));
  }
  return {};
}

/// Fails if flags choose the sets: the tables of docs/clock_figures.md always have the same sets.
Result<void> check_markdown(const Sources& given) {
  for (const auto& [name, source] : given) {
    if (name != "markdown" && name != "first") {
      return wrong(flag_of(name), "no flag but --first beside --markdown, whose sets are its own",
                   "both");
    }
  }
  return {};
}

/// Fails if no bars are stated for this length, or only for more seeds; with bursts, bars are
/// stated for one minute.
Result<void> check_bars(const Wanted& wanted) {
  const auto* found =
      std::find_if(least_seeds.begin(), least_seeds.end(),
                   [&](const LeastSeeds& least) { return least.minutes == wanted.minutes; });
  const std::string minutes = fmt::format("{}", wanted.minutes);
  if (found == least_seeds.end()) {
    return wrong("--minutes", "1, 10 or 60, for which bars are stated", minutes);
  }
  if (wanted.bursts && wanted.minutes != 1.0) {
    return wrong("--minutes", "1, for which bars with --bursts are stated", minutes);
  }
  if (static_cast<std::uint64_t>(wanted.seeds) < found->seeds) {
    return wrong("--seeds", fmt::format("{} or more, for which bars are stated", found->seeds),
                 fmt::format("{}", wanted.seeds));
  }
  return {};
}

}  // namespace

Result<Wanted> wanted_from(const std::vector<std::string>& words) {
  Wanted wanted;
  Switches switches;
  const Parsed parsed = KA_TRY(parse_words(words, describe(wanted, switches), {}));
  if (parsed.help) {
    wanted.output = Wanted::Output::help;
    return wanted;
  }
  KA_TRY(check_links(wanted.links));
  if (switches.markdown) {
    KA_TRY(check_markdown(parsed.given));
    wanted.output = Wanted::Output::markdown;
  } else if (switches.bars) {
    KA_TRY(check_bars(wanted));
    wanted.output = Wanted::Output::bars;
  }
  return wanted;
}

const std::string_view help_page =
    R"(usage: kinalign_clock_table [--minutes M] [--seeds N] [--first SEED] [--links LETTERS]
                            [--bursts] [--bars | --markdown]

Every method on every simulated link, on the same traces, held against the truth.

  --minutes M      length of a recording, 0.5 to 600 (1)
  --seeds N        recordings of each link (20)
  --first SEED     seeds SEED, SEED + 1, ...; without it such as nobody has seen
  --links LETTERS  of A wired, B quiet, C the paper's, D modem sleep, E congested, F roaming,
                   G thin floor (ABCDEFG)
  --bursts         half of all packets lost, 2 s at a time
  --bars           hold the figures against the promises of that length: 1, 10 or 60 minutes
  --markdown       the measured tables of docs/clock_figures.md, from four sets of its own

  kinalign_clock_table --minutes 10 --links CF
  kinalign_clock_table --bars --seeds 60 --first 71000
  kinalign_clock_table --links C --seeds 1 --first 71023
  kinalign_clock_table --markdown --first 51000

Ends with 0; 1 where a certified stamp is wrong or a bar is missed; 2 where it is used wrongly.
)";

}  // namespace kinalign
