// SPDX-License-Identifier: Apache-2.0
// Measures every method on one link, on the same simulated exchanges: the tables print the figures
// and the bars judge them.
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

constexpr double live_since_s = 10.0;  // in the first seconds the clock still converges

/// The recordings of `seeds` seeds from `first` on.
struct RunSet {
  double minutes = 1.0;
  std::uint64_t seeds = 20, first = 0;
  bool bursts = false;  // half of all packets lost, 2 s at a time
};

/// The rows of a table: other methods in their order, then ours. Net: without the seed's (Fu - Fd)
/// / 2.
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

/// A figure of a set. If one seed alone gave it, as the worst, that seed is named.
struct Extreme {
  double value = 0.0;
  std::optional<std::uint64_t> seed{};
};

/// The errors of one method over all seeds of a set, s.
struct MethodFigures {
  std::string name;
  double pooled = 0.0;  // RMS of all stamps
  double p99 = 0.0;     // mean over seeds
  Extreme worst_seed;   // RMS
  Extreme worst_stamp;
};

/// The intervals of one clock. Widths are those of certified stamps; live: after 10 s.
struct IntervalFigures {
  std::uint64_t frames = 0;     // frames that were received
  std::uint64_t certified = 0;  // frames whose stamp is certified and was not withdrawn
  std::uint64_t wrong = 0;      // certified frames whose true time lies outside
  std::uint64_t outside = 0;    // frames whose true time lies outside, certified or not
  double half_width = 0.0, half_width_p99 = 0.0;  // s
};

/// Seconds from the first frame until the live error stays under a limit, over the seeds.
struct StartFigures {
  double limit = 0.0;  // s, of the error
  double median = 0.0, p90 = 0.0, worst = 0.0;
};

/// The ratio of the RMS of the method T2 - d to the offline clock's RMS.
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
  /// Only for sets of a minute without bursts: starts after a reboot, and the number of stamps
  /// outside their intervals, live and offline, for other clocks that the assumptions allow.
  std::vector<StartFigures> restarts;
  std::uint64_t outside_of_other_clocks = 0;
  GainFigures over_each_delay, over_mean_delay;
  /// Ratio of the pooled RMS: T2 - d with each d, to the frame number.
  double frame_number_gain = 0.0;

  const MethodFigures& of(Method method) const { return rows[static_cast<std::size_t>(method)]; }
};

LinkFigures measure(Link link, const RunSet& set);

/// One link and set of a table.
struct LinkRun {
  Link link = Link::wired;
  RunSet set;
};
/// Measures all, on two threads, and gives the figures in the order of `runs`.
std::vector<LinkFigures> measure(std::span<const LinkRun> runs);

}  // namespace kinalign
