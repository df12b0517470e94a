// SPDX-License-Identifier: Apache-2.0
#include "tools/clock_table/measure.h"

#include "tools/clock_table/judge.h"
#include "tools/clock_table/peers.h"
#include "tools/clock_table/promises.h"

#include "kinalign/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string_view>

namespace kinalign {

namespace {

constexpr double start_watched_s = 30.0;

using Errors = std::vector<std::vector<double>>;  // s, one vector for each seed

/// Intervals of all seeds.
struct Intervals {
  IntervalFigures sums;
  std::vector<double> half_widths;  // s, of frames sent from `begin` on

  void add(const JudgedRun& run, double begin) {
    sums.frames += run.frames;
    sums.wrong += run.lies();
    for (const JudgedStamp& stamp : run.stamps) {
      sums.outside += stamp.outside ? 1 : 0;
      if (!stamp.certified || stamp.withdrawn) continue;
      ++sums.certified;
      if (stamp.sent >= begin) half_widths.push_back(stamp.half_width);
    }
  }
};

constexpr Reboot reboot{.at = 20.0, .gap = 1.0};

/// The results that are kept of all seeds.
struct Gathered {
  std::array<Errors, methods> errors;
  Errors each_delay_from_the_start;  // errors of each_delay counted from the first frame on
  Intervals live, offline;
  std::vector<std::vector<double>> starts, restarts;  // s, one vector for each limit of the link
  std::uint64_t outside_of_other_clocks = 0;
};

std::vector<double> since(const PeerErrors& found, double begin) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < found.sent.size(); ++i) {
    if (found.sent[i] >= begin) errors.push_back(found.error[i]);
  }
  return errors;
}

/// Seconds from `begin` until the error stays within the limit for the rest of half a minute.
double start_time(const JudgedRun& run, double begin, double limit) {
  std::optional<double> last;
  for (const JudgedStamp& stamp : run.stamps) {
    if (stamp.sent < begin || stamp.sent >= begin + start_watched_s) continue;
    if (!last || std::abs(stamp.error) > limit) last = stamp.arrival - begin;
  }
  return last.value_or(0.0);
}

void gather_starts(const JudgedRun& run, double begin, const std::vector<double>& limits,
                   std::vector<std::vector<double>>& starts) {
  starts.resize(limits.size());
  for (std::size_t i = 0; i < limits.size(); ++i) {
    starts[i].push_back(start_time(run, begin, limits[i]));
  }
}

std::vector<double> start_limits(Link link) {
  std::vector<double> limits;
  for (const StartBars& start : start_bars) {
    if (start.link == link) limits.push_back(start.limit);
  }
  return limits;
}

void gather(Link link, const SimulatedExchanges& run, Gathered& all) {
  std::size_t row = 0;
  for (const Peer& peer : peers()) {
    all.errors[row++].push_back(since(peer.errors(run), peer.live ? live_since_s : 0.0));
  }
  all.each_delay_from_the_start.push_back(peers().front().errors(run).error);
  const JudgedRun live = judge_live(run), offline = judge_offline(run);
  all.errors[row++].push_back(errors_since(live, live_since_s));
  all.errors[row++].push_back(errors_since(live, live_since_s, live.asymmetry));
  all.errors[row++].push_back(errors_since(offline, 0.0));
  all.errors[row].push_back(errors_since(offline, 0.0, offline.asymmetry));
  all.live.add(live, live_since_s);
  all.offline.add(offline, 0.0);
  gather_starts(live, 0.0, start_limits(link), all.starts);
}

std::uint64_t outside(const JudgedRun& run) {
  return static_cast<std::uint64_t>(
      std::count_if(run.stamps.begin(), run.stamps.end(),
                    [](const JudgedStamp& stamp) { return stamp.outside; }));
}

/// Measures the promises about restarts and about other clocks than the usual one.
void gather_others(const ExchangeOptions& usual, std::uint64_t seed, Gathered& all) {
  ExchangeOptions options = usual;
  options.reboots = {reboot};
  gather_starts(judge_live(simulate_exchanges(options, seed)), reboot.at + reboot.gap,
                start_limits(usual.link.link), all.restarts);
  options.reboots.clear();
  for (const NodeClockOptions& clock : other_clocks) {
    options.clock = clock;
    const SimulatedExchanges run = simulate_exchanges(options, seed);
    all.outside_of_other_clocks += outside(judge_live(run)) + outside(judge_offline(run));
  }
}

std::vector<double> pooled(const Errors& errors) {
  std::vector<double> all;
  for (const auto& seed : errors) all.insert(all.end(), seed.begin(), seed.end());
  return all;
}

double at_share(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();  // NaN meets no bar
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  return values[static_cast<std::size_t>(std::min(n - 1.0, n * share))];
}

void raise(Extreme& most, double value, std::uint64_t seed) {
  if (value > most.value) most = {value, seed};
}

MethodFigures summary(std::string name, const Errors& errors, std::uint64_t first) {
  MethodFigures out;
  out.name = std::move(name);
  out.pooled = figures(pooled(errors)).rms;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const ErrorFigures f = figures(errors[i]);
    out.p99 += f.p99 / static_cast<double>(errors.size());
    raise(out.worst_seed, f.rms, first + i);
    raise(out.worst_stamp, f.worst, first + i);
  }
  return out;
}

IntervalFigures summary(const Intervals& intervals) {
  IntervalFigures out = intervals.sums;
  const auto& widths = intervals.half_widths;
  out.half_width =
      std::accumulate(widths.begin(), widths.end(), 0.0) / static_cast<double>(widths.size());
  out.half_width_p99 = at_share(widths, 0.99);
  return out;
}

std::vector<StartFigures> summary(const std::vector<double>& limits,
                                  const std::vector<std::vector<double>>& times) {
  std::vector<StartFigures> out;
  for (std::size_t i = 0; i < times.size(); ++i) {
    out.push_back(
        {limits[i], at_share(times[i], 0.5), at_share(times[i], 0.9), at_share(times[i], 1.0)});
  }
  return out;
}

GainFigures gain(const Errors& paper, const Errors& ours, std::uint64_t first) {
  std::vector<double> gains;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    gains.push_back(figures(paper[i]).rms / figures(ours[i]).rms);
  }
  const auto least = std::min_element(gains.begin(), gains.end());
  return {at_share(gains, 0.5),
          {*least, first + static_cast<std::uint64_t>(least - gains.begin())},
          figures(pooled(paper)).rms / figures(pooled(ours)).rms};
}

std::string name_of(std::size_t row) {
  constexpr std::array<std::string_view, 4> ours{"kinalign, live", "  less asymmetry",
                                                 "kinalign, offline", "  less asymmetry"};
  return std::string(is_ours(row) ? ours[row - peers().size()] : peers()[row].name);
}

}  // namespace

LinkFigures measure(Link link, const RunSet& set) {
  ExchangeOptions options;
  options.length_s = 60.0 * set.minutes;
  options.link.link = link;
  options.link.bursts = set.bursts;
  Gathered all;
  for (std::uint64_t seed = set.first; seed < set.first + set.seeds; ++seed) {
    gather(link, simulate_exchanges(options, seed), all);
    if (set.minutes == 1.0 && !set.bursts) gather_others(options, seed, all);
  }
  LinkFigures out;
  out.link = link;
  for (std::size_t row = 0; row < methods; ++row) {
    out.rows[row] = summary(name_of(row), all.errors[row], set.first);
  }
  out.live = summary(all.live);
  out.offline = summary(all.offline);
  out.starts = summary(start_limits(link), all.starts);
  out.restarts = summary(start_limits(link), all.restarts);
  out.outside_of_other_clocks = all.outside_of_other_clocks;
  const auto& offline = all.errors[static_cast<std::size_t>(Method::offline)];
  const auto& mean_delay = all.errors[static_cast<std::size_t>(Method::mean_delay)];
  out.over_each_delay = gain(all.each_delay_from_the_start, offline, set.first);
  out.over_mean_delay = gain(mean_delay, offline, set.first);
  out.frame_number_gain =
      figures(pooled(all.each_delay_from_the_start)).rms / out.of(Method::frame_number).pooled;
  return out;
}

std::vector<LinkFigures> measure(std::span<const LinkRun> runs) {
  std::vector<LinkFigures> out(runs.size());
  parallel_for(runs.size(), 2, [&](std::size_t i) { out[i] = measure(runs[i].link, runs[i].set); });
  return out;
}

}  // namespace kinalign
