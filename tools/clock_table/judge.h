// SPDX-License-Identifier: Apache-2.0
// A clock compared with the truth of simulated exchanges.
#pragma once

#include "kinalign/clock/offline/offline_clock.h"
#include "kinalign/simulate/nodes/exchanges.h"

#include <vector>

namespace kinalign {

/// Seconds of the simulation on the host's axis, rounded to the side on which a real stamp errs: an
/// arrival is never early, a departure never late.
HostTime arrival_time(double seconds);
HostTime departure_time(double seconds);
NodeTime counter_time(std::int64_t microseconds);
double seconds_of(HostTime t);

/// A stamp as it was given when its frame arrived.
struct JudgedStamp {
  double sent = 0.0, arrival = 0.0;
  double error = 0.0;       // s, likeliest minus truth
  double half_width = 0.0;  // s, half of the interval; 0: an end is open
  bool certified = false;   // at the time when it was given
  bool withdrawn = false;   // withdrawn later
  bool outside = false;     // the truth lies outside the interval
};

struct JudgedRun {
  std::vector<JudgedStamp> stamps;
  std::vector<ClockEvent> events;
  /// Frames that arrived, without duplicates; frames without a stamp count only here.
  std::uint64_t frames = 0;
  double asymmetry = 0.0;  // s, (Fu - Fd) / 2 of the floors, which no exchange can show

  std::uint64_t count(ClockEvent::Kind kind) const;
  /// Stamps that were certified, were not withdrawn, and are wrong.
  std::uint64_t lies() const;
};

/// The exchanges that the host received, without duplicates, in the order in which a receiver gives
/// them.
std::vector<Exchange> exchanges_of(const SimulatedExchanges& exchanges);

/// Fits the whole recording and asks for the stamp of each frame.
JudgedRun judge_offline(const SimulatedExchanges& exchanges, const Assumptions& assumptions = {});

/// Gives the received exchanges to a live clock and asks for each frame's stamp as it arrives.
JudgedRun judge_live(const SimulatedExchanges& exchanges, const Assumptions& assumptions = {});

/// The errors of some stamps, s.
struct ErrorFigures {
  double rms = 0.0, p99 = 0.0, worst = 0.0;
};
ErrorFigures figures(std::vector<double> errors);

/// Errors of stamps given to frames sent from `begin` on, less `asymmetry`.
std::vector<double> errors_since(const JudgedRun& run, double begin, double asymmetry = 0.0);

}  // namespace kinalign
