// SPDX-License-Identifier: Apache-2.0
// Every method on one link, on the same traces: what the tables print and the bars judge.
#pragma once

#include "kinalign/simulate/nodes/link.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

constexpr double live_since_s = 10.0;  // the first seconds are those of convergence

/// Recordings of so many seeds from `first` on.
struct RunSet {
  double minutes = 1.0;
  std::uint64_t seeds = 20, first = 0;
  bool bursts = false;  // half of all packets lost, 2 s at a time
};

/// Rows of a table: the peers in their order, then ours. Net: less (Fu - Fd) / 2 of the seed.
enum class Method : std::uint8_t {
  each_delay,
  mean_delay,
  frame_number,
  sntp,
  lsl,
  lsl_offline,
  kalman,
  live,
  live_net,
  offline,
  offline_net
};
constexpr std::size_t methods = 11;
constexpr bool is_ours(std::size_t row) { return row >= static_cast<std::size_t>(Method::live); }

/// A figure of a set, and the seed that gave it, where one alone did: the worst.
struct Extreme {
  double value = 0.0;
  std::optional<std::uint64_t> seed{};
};

/// Of one method over all seeds of a set, s.
struct MethodFigures {
  std::string name;
  double pooled = 0.0;  // RMS of all stamps
  double p99 = 0.0;     // mean over seeds
  Extreme worst_seed;   // RMS
  Extreme worst_stamp;
};

/// Of the intervals of one clock. Widths are of certified stamps; live: after 10 s.
struct IntervalFigures {
  std::uint64_t frames = 0;                       // heard
  std::uint64_t certified = 0;                    // of their stamps, and not withdrawn
  std::uint64_t wrong = 0;                        // certified, and the truth outside
  std::uint64_t outside = 0;                      // the truth, certified or not
  double half_width = 0.0, half_width_p99 = 0.0;  // s
};

/// Seconds from the first frame until the live error stays under a limit, over the seeds.
struct StartFigures {
  double limit = 0.0;  // s, of the error
  double median = 0.0, p90 = 0.0, worst = 0.0;
};

/// How many times less than T2 - d's the offline clock's RMS is.
struct GainFigures {
  double median = 0.0;
  Extreme least;
  double pooled = 0.0;
};

struct LinkFigures {
  Link link = Link::wired;
  std::array<MethodFigures, methods> rows;
  IntervalFigures live, offline;
  std::vector<StartFigures> starts;  // in the order of start_bars
  /// Sets of a minute without bursts: after a reboot, and what other clocks that the assumptions
  /// allow have outside their intervals, live and offline.
  std::vector<StartFigures> restarts;
  std::uint64_t outside_of_other_clocks = 0;
  GainFigures over_each_delay, over_mean_delay;
  double frame_number_gain = 0.0;  // over T2 - d, each d, pooled

  const MethodFigures& of(Method method) const { return rows[static_cast<std::size_t>(method)]; }
};

LinkFigures measure(Link link, const RunSet& set);

/// One of the jobs of a table.
struct LinkRun {
  Link link = Link::wired;
  RunSet set;
};
/// On both processors, in the order given.
std::vector<LinkFigures> measure(std::span<const LinkRun> runs);

}  // namespace kinalign
