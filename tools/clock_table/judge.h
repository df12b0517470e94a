// SPDX-License-Identifier: Apache-2.0
// A clock held against the truth of simulated exchanges.
#pragma once

#include "kinalign/clock/offline/offline_clock.h"
#include "kinalign/simulate/nodes/exchanges.h"

#include <vector>

namespace kinalign {

/// Seconds of the simulation on the host's axis, to the side that a stamp errs to: an arrival is
/// never early, a departure never late.
HostTime arrival_time(double seconds);
HostTime departure_time(double seconds);
NodeTime counter_time(std::int64_t microseconds);
double seconds_of(HostTime t);

/// A stamp as it was given when its frame arrived.
struct JudgedStamp {
  double sent = 0.0, heard = 0.0;
  double error = 0.0;       // s, likeliest minus truth
  double half_width = 0.0;  // s, of the interval; 0 where an end is open
  bool certified = false;   // as it was given
  bool withdrawn = false;   // later
  bool outside = false;     // the truth, of the interval
};

struct JudgedRun {
  std::vector<JudgedStamp> stamps;
  std::vector<ClockEvent> events;
  std::uint64_t frames = 0;  // heard, duplicates aside; those without a stamp count here alone
  double asymmetry = 0.0;    // (Fu - Fd) / 2, which no exchange can see, s

  std::uint64_t count(ClockEvent::Kind kind) const;
  /// Stamps that were certified, were not withdrawn, and are wrong.
  std::uint64_t lies() const;
};

/// What the host heard, duplicates left out, as a receiver would hand it on.
std::vector<Exchange> exchanges_of(const SimulatedExchanges& exchanges);

/// Fits the whole recording and asks for each frame.
JudgedRun judge_offline(const SimulatedExchanges& exchanges, const Assumptions& assumptions = {});

/// Plays what the host heard into a live clock and asks for each frame as it arrives.
JudgedRun judge_live(const SimulatedExchanges& exchanges, const Assumptions& assumptions = {});

/// Of the errors of some stamps, s.
struct ErrorFigures {
  double rms = 0.0, p99 = 0.0, worst = 0.0;
};
ErrorFigures figures(std::vector<double> errors);

/// Errors of stamps given to frames sent from `begin` on, less `asymmetry`.
std::vector<double> errors_since(const JudgedRun& run, double begin, double asymmetry = 0.0);

}  // namespace kinalign
