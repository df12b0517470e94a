// SPDX-License-Identifier: Apache-2.0
#include "tools/clock_table/bars.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

constexpr double ms = 1e3;  // figures are in s, most bars in ms

/// Collects the verdicts on one link. Columns without a bar are left out.
struct Sheet {
  Link link;
  std::vector<Verdict>& verdicts;

  void at_most(const std::string& source, const std::string& column, Extreme measured, Bar bar) {
    if (bar) verdicts.push_back({source, link, column, measured, *bar});
  }
  void at_least(const std::string& source, const std::string& column, Extreme measured, Bar bar) {
    if (bar) verdicts.push_back({source, link, column, measured, *bar, true});
  }
};

/// A figure of all seeds together, so no single seed is named.
Extreme of_all(double value) { return {value, {}}; }
Extreme in_ms(Extreme seconds) { return {seconds.value * ms, seconds.seed}; }
Extreme in_ms(double seconds) { return of_all(seconds * ms); }

void judge_gains(const GainBars& bars, const LinkFigures& f, Sheet& sheet) {
  const GainFigures &each = f.over_each_delay, &mean = f.over_mean_delay;
  const double live = f.of(Method::each_delay).pooled / f.of(Method::live).pooled;
  sheet.at_least("5.2", "gain, offline, over each d, every seed", each.least, bars.every_seed);
  sheet.at_least("5.2", "gain, offline, over mean d, every seed", mean.least, bars.every_seed);
  sheet.at_least("5.2", "gain, offline, over each d, pooled", of_all(each.pooled), bars.pooled);
  sheet.at_least("5.2", "gain, offline, over mean d, pooled", of_all(mean.pooled), bars.pooled);
  sheet.at_least("5.2", "gain, live, over each d, pooled", of_all(live), bars.live);
  sheet.at_least("5.2", "gain, frame number, over each d, pooled", of_all(f.frame_number_gain),
                 bars.frame_number);
}

const ErrorBars& error_bars(double minutes) {
  if (minutes == 60.0) return errors_of_an_hour;
  return minutes == 10.0 ? errors_of_ten_minutes : errors_of_a_minute;
}

}  // namespace

std::array<Bar, 7> error_bars(const RunSet& set, Link link) {
  std::array<Bar, 7> bars = error_bars(set.minutes)[static_cast<std::size_t>(link)];
  for (Bar& bar : bars) {
    if (bar && set.bursts) bar = *bar * bursts_allow;
  }
  return bars;
}

namespace {

void judge_errors(const RunSet& set, const LinkFigures& f, Sheet& sheet) {
  const MethodFigures &offline = f.of(Method::offline), &live = f.of(Method::live);
  const auto bars = error_bars(set, f.link);
  const auto judge = [&](const char* column, Extreme measured, Bar bar) {
    sheet.at_most(set.bursts ? "5.5" : "5.3", column, measured, bar);
  };
  judge("offline, pooled RMS, ms", in_ms(offline.pooled), bars[0]);
  judge("offline, worst seed's RMS, ms", in_ms(offline.worst_seed), bars[1]);
  judge("offline, worst stamp, ms", in_ms(offline.worst_stamp), bars[2]);
  judge("offline, pooled RMS less asymmetry, ms", in_ms(f.of(Method::offline_net).pooled), bars[3]);
  judge("live, pooled RMS, ms", in_ms(live.pooled), bars[4]);
  judge("live, p99, ms", in_ms(live.p99), bars[5]);
  judge("live, worst stamp, ms", in_ms(live.worst_stamp), bars[6]);
}

double certified_share(const IntervalFigures& f) {
  return static_cast<double>(f.certified) / static_cast<double>(f.frames);
}

/// Judges all stamps, also those that were not certified or were withdrawn. Stamps that are seldom
/// certified must not help: most frames must have a stamp that stays certified.
void judge_coverage(const LinkFigures& f, Sheet& sheet) {
  sheet.at_least("ours", "offline, share of frames that stay certified",
                 of_all(certified_share(f.offline)), least_certified);
  sheet.at_least("ours", "live, share of frames that stay certified",
                 of_all(certified_share(f.live)), least_certified);
  sheet.at_most("5.4", "offline, truths outside their interval",
                of_all(static_cast<double>(f.offline.outside)), 0.0);
  sheet.at_most("5.4", "live, truths outside their interval",
                of_all(static_cast<double>(f.live.outside)), 0.0);
}

void judge_widths(const LinkFigures& f, Sheet& sheet) {
  const auto& bars = width_bars[static_cast<std::size_t>(f.link)];
  sheet.at_most("5.4", "offline, half width, ms", in_ms(f.offline.half_width), bars[0]);
  sheet.at_most("5.4", "live, half width, ms", in_ms(f.live.half_width), bars[1]);
  sheet.at_most("5.4", "live, half width, p99, ms", in_ms(f.live.half_width_p99), bars[2]);
}

void judge_starts(const LinkFigures& f, Sheet& sheet) {
  std::size_t i = 0;
  for (const StartBars& bars : start_bars) {
    if (bars.link != f.link) continue;
    const auto judge = [&](const char* what, const StartFigures& start, Bar median) {
      const std::string column = fmt::format("{}, live under {} ms", what, bars.limit * ms);
      sheet.at_most("5.5", column + ", median, s", of_all(start.median), median);
      sheet.at_most("5.5", column + ", p90, s", of_all(start.p90), bars.p90);
    };
    judge("start", f.starts[i], bars.median);
    judge("after a reboot", f.restarts[i++],
          median_holds_after_a_reboot(f.link) ? Bar(bars.median) : no_bar);
  }
}

void judge_reference(const ReferenceFigures& figures, const LinkFigures& f, Sheet& sheet) {
  const auto beat = [&](const char* column, double measured, Bar figure) {
    sheet.at_most("reference", column, in_ms(measured), figure);
  };
  beat("offline, pooled RMS, ms", f.of(Method::offline).pooled, figures.offline);
  beat("live, pooled RMS, ms", f.of(Method::live).pooled, figures.live);
  beat("live, pooled RMS less asymmetry, ms", f.of(Method::live_net).pooled, figures.live_net);
  beat("live, p99, ms", f.of(Method::live).p99, figures.live_p99);
}

}  // namespace

std::vector<Verdict> verdicts(const RunSet& set, std::span<const LinkFigures> tables) {
  std::vector<Verdict> all;
  for (const LinkFigures& f : tables) {
    Sheet sheet{f.link, all};
    judge_errors(set, f, sheet);
    judge_coverage(f, sheet);
    if (set.bursts) continue;  // sets with bursts have no further promises
    for (const GainBars& bars : gain_bars) {
      if (f.link == Link::paper && bars.minutes == set.minutes) judge_gains(bars, f, sheet);
    }
    judge_widths(f, sheet);
    if (set.minutes == 1.0) {  // sets of a minute, which have 20 seeds
      judge_starts(f, sheet);
      sheet.at_most("5.4", "other clocks, truths outside their interval",
                    of_all(static_cast<double>(f.outside_of_other_clocks)), 0.0);
    }
    for (const ReferenceFigures& figures : reference_figures) {
      if (figures.link == f.link && figures.minutes == set.minutes) {
        judge_reference(figures, f, sheet);
      }
    }
  }
  return all;
}

}  // namespace kinalign
