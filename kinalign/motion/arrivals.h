// SPDX-License-Identifier: Apache-2.0
// How late samples were stamped that are stamped where they arrive, as far as the samples behind
// them show it.
#pragma once

#include <cstdint>
#include <deque>

namespace kinalign {

/// Of two samples nearer than this share of the usual step the first was held back on its way: a
/// hand that moves on within 0.1 ms would be metres away in between. KinectMultiTrack's server
/// stamps are 8 of 34 ms apart at the least.
constexpr std::int64_t near_share = 5;

/// Samples this many steps late are stale by more than what counts as a gap.
constexpr std::int64_t late_steps = 3;

struct Arrivals {
  std::uint64_t near = 0;          // less than a fifth of a step in front of the next one
  std::uint64_t late = 0;          // stamped at least late_steps steps after they were taken
  std::int64_t worst_late_ns = 0;  // of these, the worst; what is known to be its least
  bool first_late = false;         // the first sample is one of them

  bool operator==(const Arrivals&) const = default;
};

/// A device takes a sample each step. Sample i, which was taken j - i steps before sample j, was
/// not taken later than that before j arrived: late_i >= (j - i) step - (t_j - t_i). Samples that
/// come quicker than they are taken have waited, and so a pause stands in front of them, which is
/// as long at the least: late_i <= t_i - t_k - (i - k) step behind a punctual sample k. A device
/// that now and then measures quicker makes no pause before. The step may be 5 % off: a median of
/// stamps in whole milliseconds is by 2 or 3.
class ArrivalSurveyor {
 public:
  /// 0: no step is known, nothing is told.
  explicit ArrivalSurveyor(std::int64_t step_ns) : step_(static_cast<double>(step_ns)) {}

  /// Rising stamps, ns.
  void add(std::int64_t t);
  /// The last one was no sample.
  void take_back();
  /// Whether the last one can be late by half a step and more.
  bool can_be_late() const;
  const Arrivals& result() const { return now_.found; }

 private:
  /// One that came behind a pause: it may turn out to have waited.
  struct Candidate {
    std::uint64_t index = 0;
    double after_line = 0.0;  // t - slowest step x index, ns
    double pause = 0.0;       // how late it can be, ns
    bool late = false;
  };
  /// All that is known behind a sample.
  struct State {
    std::uint64_t count = 0;
    std::int64_t first = 0, last = 0;  // stamps, ns
    double pause = 0.0;                // how late the last can be, ns
    bool start = false;                // all came in haste so far
    std::deque<Candidate> candidates;  // of the last `reach` samples
    Arrivals found;
  };

  double pause_behind(double pause, double step) const;
  void find_late(double after_line, double least);

  double step_;
  State now_, before_;
};

}  // namespace kinalign
