// SPDX-License-Identifier: Apache-2.0
#include "tools/clock_table/markdown.h"

#include "tools/clock_table/bars.h"
#include "tools/clock_table/print.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string_view>

namespace kinalign {

namespace {

using Tables = std::vector<LinkFigures>;

constexpr std::array<std::string_view, methods> names{"T2 − d, each d (the paper), re-implemented",
                                                      "T2 − d, mean d (the paper), re-implemented",
                                                      "frame number, no counter (ours)",
                                                      "SNTP-like, live, re-implemented",
                                                      "LSL-like, live, re-implemented",
                                                      "LSL-like, offline, re-implemented",
                                                      "Kalman filter, live, re-implemented",
                                                      "**kinalign, live**",
                                                      "… less floor asymmetry",
                                                      "**kinalign, offline**",
                                                      "… less floor asymmetry"};

/// Three significant digits, but no more than a tenth of a microsecond.
std::string shown_ms(double seconds) {
  const double value = seconds * 1e3;
  if (value >= 100.0) return fmt::format("{:.0f}", value);
  if (value >= 10.0) return fmt::format("{:.1f}", value);
  if (value >= 1.0) return fmt::format("{:.2f}", value);
  return fmt::format("{:.{}f}", value, value >= 0.1 ? 3 : 4);
}

/// "1,234,567"
std::string shown_count(std::uint64_t n) {
  std::string text = std::to_string(n);
  for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, ",");
  return text;
}

/// A share in percent; it is rounded to 100 only if it is complete.
std::string shown_share(std::uint64_t part, std::uint64_t whole) {
  const double share = static_cast<double>(part) / static_cast<double>(whole);
  return part == whole ? "100" : fmt::format("{:.2f}", std::floor(share * 1e4) / 1e2);
}

/// The text above a table: its content, its unit, and the promised bars.
std::string caption(std::string_view title, std::string_view what, std::string_view bars) {
  return fmt::format("\n**{}** {} Bars: {}.\n", title, what, bars);
}

std::string head(std::string_view title) {
  return fmt::format(
      "\n| {} | A wired | B quiet | C paper's | D modem sleep | E congested | F roaming | "
      "G thin floor |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n",
      title);
}

/// A row with a cell for each link: for one set, or for two, "1 min / 10 min".
std::string row(std::string_view name, const std::function<std::string(std::size_t)>& cell) {
  std::string text = fmt::format("| {} |", name);
  for (std::size_t link = 0; link < links; ++link) text += fmt::format(" {} |", cell(link));
  return text + "\n";
}

using Shown = std::function<std::string(const LinkFigures&)>;

std::string row(std::string_view name, const Tables& one, const Tables& other, const Shown& shown) {
  return row(name, [&](std::size_t i) { return shown(one[i]) + " / " + shown(other[i]); });
}

/// Two sets that stand side by side in a table, "1 min / 10 min".
struct Beside {
  const RunSet &one_set, &other_set;
  const Tables &one, &other;
};

std::string shown_bar(Bar ms) { return ms ? fmt::format("{:g}", *ms) : "none"; }

/// A row of promised bars; `column`: an index in ErrorBars.
struct BarRow {
  std::string_view name;
  std::size_t column;
};

std::string bar_row(const BarRow& bar, const Beside& sets) {
  return row(bar.name, [&](std::size_t i) {
    const auto link = static_cast<Link>(i);
    return shown_bar(error_bars(sets.one_set, link)[bar.column]) + " / " +
           shown_bar(error_bars(sets.other_set, link)[bar.column]);
  });
}

std::string errors(std::string_view title, const Beside& sets,
                   double (*figure)(const MethodFigures&), std::span<const BarRow> bars) {
  std::string text = head(title);
  for (std::size_t i = 0; i < methods; ++i) {
    text += row(names[i], sets.one, sets.other,
                [&](const LinkFigures& f) { return shown_ms(figure(f.rows[i])); });
  }
  for (const BarRow& bar : bars) text += bar_row(bar, sets);
  return text;
}

constexpr std::array pooled_bars{BarRow{"bar: kinalign, live", 4},
                                 BarRow{"bar: kinalign, offline", 0},
                                 BarRow{"bar: … less floor asymmetry", 3}};
constexpr std::array p99_bars{BarRow{"bar: kinalign, live", 5}};
constexpr std::array worst_bars{BarRow{"bar: kinalign, live", 6},
                                BarRow{"bar: kinalign, offline", 2}};

double pooled(const MethodFigures& f) { return f.pooled; }
double p99(const MethodFigures& f) { return f.p99; }
double worst_stamp(const MethodFigures& f) { return f.worst_stamp.value; }

std::string certified_row(std::string_view name, const Tables& tables,
                          IntervalFigures LinkFigures::*clock) {
  return row(name, [&](std::size_t i) {
    const IntervalFigures& f = tables[i].*clock;
    return shown_share(f.certified, f.frames);
  });
}

std::string certificates(const PageFigures& page) {
  std::string text = caption(
      "How often there is a certificate.",
      "Frames whose stamp is certified, and not withdrawn later, in percent; more is better.",
      fmt::format("{:g} %, and none of those stamps wrong, in `--bars` of each length",
                  least_certified * 100.0));
  text += head("frames with a certified stamp, %");
  std::uint64_t certified = 0, wrong = 0;
  const auto rows = [&](std::string_view set, const Tables& tables) {
    text += certified_row(fmt::format("offline, {}", set), tables, &LinkFigures::offline);
    text += certified_row(fmt::format("live, {}", set), tables, &LinkFigures::live);
    for (const LinkFigures& f : tables) {
      certified += f.offline.certified + f.live.certified;
      wrong += f.offline.wrong + f.live.wrong;
    }
  };
  rows("1 min", page.minute);
  rows("10 min", page.ten_minutes);
  rows("60 min", page.hour);
  rows("half of all lost", page.bursts);
  return text + fmt::format("\nOf {} certified stamps in all these runs {} were wrong.\n",
                            shown_count(certified), wrong);
}

std::string widths(const PageFigures& page) {
  std::string text = caption("How wide certified intervals are.",
                             "Half of each, in ms: the mean and p99 over frames.",
                             "in `--bars` and `--bars --minutes 10`, the same for both lengths");
  text += head("half width, ms: 1 min / 10 min");
  text += row("(Fu + Fd) / 2: no exchange sees less", [&](std::size_t i) {
    const Floors least = floors(static_cast<Link>(i), page.sets.minute.first);
    return fmt::format("{:g}", (least.up + least.down) / 2.0 * 1e3);
  });
  const auto both = [&](std::string_view name, const Shown& shown) {
    return row(name, page.minute, page.ten_minutes, shown);
  };
  text +=
      both("offline, mean", [](const LinkFigures& f) { return shown_ms(f.offline.half_width); });
  text += both("live after 10 s, mean",
               [](const LinkFigures& f) { return shown_ms(f.live.half_width); });
  text += both("live after 10 s, p99",
               [](const LinkFigures& f) { return shown_ms(f.live.half_width_p99); });
  constexpr std::array<std::string_view, 3> bars{"bar: offline, mean", "bar: live, mean",
                                                 "bar: live, p99"};
  for (std::size_t i = 0; i < bars.size(); ++i) {
    text += row(bars[i], [&](std::size_t link) { return shown_bar(width_bars[link][i]); });
  }
  return text;
}

std::string gains(const PageFigures& page) {
  std::string text = caption(
      "How many times better than the paper.",
      "RMS of T2 − d over that of kinalign offline, seed by seed, without a unit; more is better.",
      "in `--bars` and `--bars --minutes 10`, on the paper's link");
  text += head("gain of offline: 1 min / 10 min");
  const auto both = [&](std::string_view name, double (*figure)(const LinkFigures&)) {
    text += row(name, page.minute, page.ten_minutes,
                [&](const LinkFigures& f) { return fmt::format("{:.0f}", figure(f)); });
  };
  both("over each d, median", [](const LinkFigures& f) { return f.over_each_delay.median; });
  both("over each d, least", [](const LinkFigures& f) { return f.over_each_delay.least.value; });
  both("over mean d, median", [](const LinkFigures& f) { return f.over_mean_delay.median; });
  both("over mean d, least", [](const LinkFigures& f) { return f.over_mean_delay.least.value; });
  const auto bar = [](std::size_t link) -> std::string {
    if (static_cast<Link>(link) != Link::paper) return "none";
    return shown_bar(gain_bars[0].every_seed) + " / " + shown_bar(gain_bars[1].every_seed);
  };
  return text + row("bar: both least", bar);
}

std::string starts(const Tables& tables) {
  std::string text =
      caption("How soon a live stamp is good.",
              "From a node's first frame until the live error stays under a limit, in s, over the "
              "seeds of 1 min; less is better.",
              "in `--bars`") +
      "\n| link | limit of the live error, ms | median, s | bar | p90, s | bar | worst, s |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n";
  const auto* bar = start_bars.begin();
  for (const LinkFigures& f : tables) {
    for (const StartFigures& start : f.starts) {
      text += fmt::format("| {} | {:g} | {:.2f} | {:g} | {:.2f} | {:g} | {:.2f} |\n",
                          letter(f.link), start.limit * 1e3, start.median, bar->median, start.p90,
                          bar->p90, start.worst);
      ++bar;
    }
  }
  return text;
}

constexpr std::string_view judged = "in `--bars` and `--bars --minutes 10`";

std::vector<LinkFigures> take(std::vector<LinkFigures>& all) {
  std::vector<LinkFigures> some(all.end() - links, all.end());
  all.resize(all.size() - links);
  return some;
}

}  // namespace

PageSets page_sets(std::uint64_t first) {
  return {.minute = {.minutes = 1.0, .seeds = 60, .first = first},
          .ten_minutes = {.minutes = 10.0, .seeds = 20, .first = first + 1000},
          .hour = {.minutes = 60.0, .seeds = 3, .first = first + 2000},
          .bursts = {.minutes = 1.0, .seeds = 20, .first = first + 3000, .bursts = true}};
}

PageFigures measure(const PageSets& sets) {
  std::vector<LinkRun> runs;
  for (const RunSet& set : {sets.hour, sets.ten_minutes, sets.minute, sets.bursts}) {
    for (std::size_t i = 0; i < links; ++i) runs.push_back({static_cast<Link>(i), set});
  }
  std::vector<LinkFigures> all = measure(runs);
  PageFigures page{sets, {}, {}, {}, {}};
  for (auto* tables : {&page.bursts, &page.minute, &page.ten_minutes, &page.hour}) {
    *tables = take(all);
  }
  return page;
}

std::string markdown(const PageFigures& page) {
  const PageSets& sets = page.sets;
  std::string text = fmt::format("<!-- made by kinalign_clock_table --markdown --first {} -->\n\n",
                                 sets.minute.first);
  for (const RunSet& set : {sets.minute, sets.ten_minutes, sets.hour, sets.bursts}) {
    text += fmt::format("- {}\n", describe(set));
  }
  const Beside short_sets{sets.minute, sets.ten_minutes, page.minute, page.ten_minutes};
  const Beside long_and_lossy{sets.hour, sets.bursts, page.hour, page.bursts};
  text += caption("How far off stamps are.",
                  "RMS over all stamps of all seeds, in ms; less is better.", judged);
  text += errors("pooled RMS, ms: 1 min / 10 min", short_sets, pooled, pooled_bars);
  text += caption("How far off a bad one is.",
                  "The error that 99 % of a seed's stamps stay under, in ms: the mean over seeds.",
                  judged);
  text += errors("p99, ms: 1 min / 10 min", short_sets, p99, p99_bars);
  text += caption("How far off the worst is.", "Of all stamps of all seeds, in ms.", judged);
  text += errors("worst stamp, ms: 1 min / 10 min", short_sets, worst_stamp, worst_bars);
  text += caption("An hour; and a minute in which half of all packets are lost, 2 s at a time.",
                  "RMS over all stamps of all seeds, in ms.",
                  "in `--bars --minutes 60` and `--bars --bursts`");
  text += errors("pooled RMS, ms: 60 min / half of all lost", long_and_lossy, pooled, pooled_bars);
  text += certificates(page) + widths(page) + gains(page) + starts(page.minute);
  return text + "\n<!-- end of what kinalign_clock_table made -->\n";
}

}  // namespace kinalign
