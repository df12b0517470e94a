// SPDX-License-Identifier: Apache-2.0
#include "tools/clock_table/arguments.h"

#include "tools/clock_table/promises.h"

#include "kinalign/core/nearest_name.h"
#include "kinalign/core/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace kinalign {

namespace {

const std::vector<std::string> with_value{"--minutes", "--seeds", "--first", "--links"};
const std::vector<std::string> switches{"--bursts", "--bars", "--markdown", "--help"};

/// Flags with the words behind them; a switch has none.
using Given = std::map<std::string, std::string>;

bool is_one_of(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

Failure wrong(std::string flag, std::string expected, std::string found) {
  return Failure(Error{std::move(flag), 0, std::move(expected), std::move(found)});
}

Result<Given> flags_of(const std::vector<std::string>& words) {
  Given given;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string flag = words[i];
    const bool takes_value = is_one_of(with_value, flag);
    if (!takes_value && !is_one_of(switches, flag)) {
      std::vector<std::string> known = with_value;
      known.insert(known.end(), switches.begin(), switches.end());
      return Failure(unknown_name(flag, "a known flag", known));
    }
    if (given.contains(flag)) return wrong(flag, "to be given once", "given twice");
    if (takes_value && i + 1 == words.size()) return wrong(flag, "a value behind it", "the end");
    given[flag] = takes_value ? words[++i] : "";
  }
  return given;
}

struct Range {
  double least, most;
};

/// The number behind a flag, or what stood there before.
Result<double> number(const Given& given, const std::string& flag, Range range, double otherwise) {
  const auto found = given.find(flag);
  if (found == given.end()) return otherwise;
  double value = 0.0;
  if (!parse_number(found->second, value) || value < range.least || value > range.most) {
    return wrong(flag, fmt::format("a number of {:g} to {:g}", range.least, range.most),
                 shown(found->second));
  }
  return value;
}

Result<std::uint64_t> count(const Given& given, const std::string& flag, Range range,
                            std::uint64_t otherwise) {
  const double value = KA_TRY(number(given, flag, range, static_cast<double>(otherwise)));
  if (value != std::floor(value)) return wrong(flag, "a whole number", given.at(flag));
  return static_cast<std::uint64_t>(value);
}

Result<std::string> links_of(const Given& given, const std::string& otherwise) {
  const auto found = given.find("--links");
  if (found == given.end()) return otherwise;
  const std::string& text = found->second;
  std::string sorted = text;
  std::sort(sorted.begin(), sorted.end());
  const bool once = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
  if (text.empty() || !once || text.find_first_not_of(otherwise) != std::string::npos) {
    return wrong("--links", "letters of " + otherwise + ", each once", shown(text));
  }
  return text;
}

/// The sets of the table in docs/performance.md are its own.
Result<void> check_markdown(const Given& given) {
  for (const auto& [flag, value] : given) {
    if (flag != "--markdown" && flag != "--first") {
      return wrong(flag, "no flag but --first beside --markdown, whose sets are its own", "both");
    }
  }
  return {};
}

/// Bars are stated for these lengths and of that many seeds; with bursts for a minute.
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
  if (wanted.seeds < found->seeds) {
    return wrong("--seeds", fmt::format("{} or more, for which bars are stated", found->seeds),
                 fmt::format("{}", wanted.seeds));
  }
  return {};
}

}  // namespace

Result<Wanted> wanted_from(const std::vector<std::string>& words) {
  const Given given = KA_TRY(flags_of(words));
  Wanted wanted;
  if (given.contains("--help")) {
    wanted.output = Wanted::Output::help;
    return wanted;
  }
  // Half a minute: live errors count from 10 s on, starts are watched for 30 s.
  wanted.minutes = KA_TRY(number(given, "--minutes", {0.5, 600}, wanted.minutes));
  wanted.seeds = KA_TRY(count(given, "--seeds", {1, 10'000}, wanted.seeds));
  wanted.links = KA_TRY(links_of(given, wanted.links));
  wanted.bursts = given.contains("--bursts");
  if (given.contains("--first")) wanted.first = KA_TRY(count(given, "--first", {0, 9e15}, 0));
  if (given.contains("--markdown")) {
    KA_TRY(check_markdown(given));
    wanted.output = Wanted::Output::markdown;
  } else if (given.contains("--bars")) {
    KA_TRY(check_bars(wanted));
    wanted.output = Wanted::Output::bars;
  }
  return wanted;
}

const std::string_view usage =
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
  --markdown       the measured tables of docs/performance.md, from four sets of its own

  kinalign_clock_table --minutes 10 --links CF
  kinalign_clock_table --bars --seeds 60 --first 71000
  kinalign_clock_table --links C --seeds 1 --first 71023
  kinalign_clock_table --markdown --first 51000

Ends with 0; 1 where a certified stamp is wrong or a bar is missed; 2 where it is used wrongly.
)";

}  // namespace kinalign
