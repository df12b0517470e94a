// SPDX-License-Identifier: Apache-2.0
// Some samples are stamped when they arrive, not when they are taken. This file estimates how late
// they were stamped, as far as later samples show it.
#pragma once

#include <cstdint>
#include <deque>

namespace kinalign {

/// Devices never stamp a sample early. If two samples are closer than 1/near_share of the usual
/// step, the first one was delayed: a hand can't move metres within 0.1 ms. The server stamps of
/// KinectMultiTrack are at least 8 ms apart, with a step of 34 ms.
constexpr std::int64_t near_share = 5;

/// A sample counts as late if it is delayed by at least this many steps.
constexpr std::int64_t late_steps = 3;

struct Arrivals {
  std::uint64_t near = 0;  // samples less than a fifth of the usual step before the next sample
  std::uint64_t late = 0;  // samples stamped at least late_steps steps after they were taken
  std::int64_t worst_late_ns = 0;  // the largest delay of the late samples; a lower bound
  bool first_late = false;         // the first sample is near the next one, or late
  bool near_only = false;  // late samples are not counted: the step is not known well enough

  bool operator==(const Arrivals&) const = default;
};

/// The device takes one sample per step. Sample i was taken (j - i) steps before a later sample j,
/// and sample j was taken before it arrived. This gives a lower bound of the delay of sample i:
/// late_i >= (j - i) step - (t_j - t_i).
///
/// Samples that arrive faster than they are taken have waited, so a pause of at least the same
/// length precedes them. This gives an upper bound, from a punctual sample k: late_i <= t_i - t_k -
/// (i - k) step. A device that sometimes measures faster leaves no pause. The pause before the
/// first sample is unknown. Therefore only a flush counts at the start: samples at most an eighth
/// of a step apart that all arrive within ten steps. The step may be wrong by 5 %.
///
/// Near samples need less evidence. A loop that reads slightly slower than the device measures
/// sometimes finds two or three samples at once, without a visible pause. Up to eight successive
/// samples may therefore be closer than a twentieth of a step, and a step of usual length may hide
/// a delay of two steps. The price: if a device begins to measure five times faster, two or three
/// samples are wrongly counted as near; with twenty times faster, eight.
class ArrivalSurveyor {
 public:
  /// `step_ns` 0: the step is unknown and nothing is counted. Not `steady`: the step is not known
  /// to 5 %, so only near samples are counted.
  explicit ArrivalSurveyor(std::int64_t step_ns, bool steady = true)
      : step_(static_cast<double>(step_ns)), steady_(steady) {}

  /// Adds a stamp, ns. Stamps must rise.
  void add(std::int64_t t);
  /// Removes the last sample, for example because its stamp was wrong. Only one sample can be
  /// removed before the next add().
  void take_back();
  /// True if the last sample turns out to be delayed when the next one comes at `t`.
  bool shows_late(std::int64_t t) const {
    return now_.count > 0 && shows_late(now_, static_cast<double>(t) - static_cast<double>(now_.t));
  }
  Arrivals result() const;

 private:
  /// A sample after a pause. A later sample may prove that it was delayed.
  struct Candidate {
    std::uint64_t index = 0;
    double after_line = 0.0;
    double pause = 0.0;  // upper bound of its delay, ns
    bool late = false;
  };
  /// The state after a sample. behind() computes it from the state after the previous sample, so
  /// two states are enough for removing one sample.
  struct Last {
    std::uint64_t count = 0, near = 0;
    std::uint64_t run = 0;  // number of successive near steps up to this sample
    std::int64_t first = 0, t = 0;
    double step = 0.0;   // time since the previous sample, ns
    double pause = 0.0;  // upper bound of the delay, from visible pauses, ns
    double doubt = 0.0;  // further delay that usual steps may hide, at most late_steps steps, ns
    bool flush = false;  // all samples so far belong to a flush
    bool first_near = false;
  };

  bool is_near(double step) const { return static_cast<double>(near_share) * step < step_; }
  double least_late() const { return static_cast<double>(late_steps) * step_; }
  bool shows_late(const Last& last, double step) const;
  Last behind(const Last& before, std::int64_t t) const;
  double after_line(const Last& last) const;
  void settle();
  void find_late(double after_line);

  double step_;
  bool steady_;
  Last now_, before_;
  bool settled_ = true;               // `now_` has been compared with earlier samples
  std::deque<Candidate> candidates_;  // only among the last `reach` samples
  Arrivals late_;                     // without near samples
};

}  // namespace kinalign
