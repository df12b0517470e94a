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
  bool first_late = false;         // the first sample is near the next one, or late
  bool near_only = false;          // no step was known by which late ones could be told

  bool operator==(const Arrivals&) const = default;
};

/// A device takes a sample each step. Sample i, which was taken j - i steps before sample j, was
/// not taken later than that before j arrived: late_i >= (j - i) step - (t_j - t_i). Samples that
/// come quicker than they are taken have waited, and so a pause stands in front of them, which is
/// as long at the least: late_i <= t_i - t_k - (i - k) step behind a punctual sample k. A device
/// that now and then measures quicker makes no pause before. In front of the first sample any
/// pause may have been: of what stands there only a flush counts, samples up to an eighth of a
/// step apart that are through within ten steps. The step may be 5 % off.
///
/// Near ones need less: a loop that reads a little slower than the device measures finds two or
/// three samples now and then, without a pause that shows. Up to eight in a row may come nearer
/// than a twentieth of a step, and any usual step may hide two steps of waiting: where a device
/// begins to measure five times quicker, two or three samples are so taken for near, of twenty
/// times quicker eight.
class ArrivalSurveyor {
 public:
  /// 0: no step is known, nothing is told. Not `steady`: it is not known to 5 %, and no more than
  /// near ones are told.
  explicit ArrivalSurveyor(std::int64_t step_ns, bool steady = true)
      : step_(static_cast<double>(step_ns)), steady_(steady) {}

  /// Rising stamps, ns.
  void add(std::int64_t t);
  /// The last one was no sample. One can be taken back, then the next is to be added.
  void take_back();
  /// Whether the last one was held back if the next comes at `t`.
  bool shows_late(std::int64_t t) const {
    return now_.count > 0 && shows_late(now_, static_cast<double>(t) - static_cast<double>(now_.t));
  }
  Arrivals result() const;

 private:
  /// One that came behind a pause: it may turn out to have waited.
  struct Candidate {
    std::uint64_t index = 0;
    double after_line = 0.0;
    double pause = 0.0;  // how late it can be, ns
    bool late = false;
  };
  /// What is known when a sample has come.
  struct Last {
    std::uint64_t count = 0, near = 0;
    std::uint64_t run = 0;  // quick steps in a row, to it
    std::int64_t first = 0, t = 0;
    double step = 0.0;   // to it, ns
    double pause = 0.0;  // how late it can be behind the pauses that show, ns
    double doubt = 0.0;  // and by steps that are usual, late_steps steps at the most
    bool flush = false;  // all so far came on each other's heels
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
  bool settled_ = true;               // `now_` has been compared with those before it
  std::deque<Candidate> candidates_;  // of the last `reach` samples
  Arrivals late_;                     // near aside
};

}  // namespace kinalign
