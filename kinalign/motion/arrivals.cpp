// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/arrivals.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

// The number of samples after which a delay can't be proven any more.
constexpr std::uint64_t reach = 256;
constexpr double slack = 0.05;   // relative uncertainty of the step
constexpr double regular = 0.2;  // a step within this share of the usual step counts as usual
constexpr double flush_share = 0.125, flush_steps = 10.0;
constexpr double heap_share = 0.05;  // share of the usual step
// At most this many successive samples may be closer than heap_share without a pause before them.
constexpr std::uint64_t heap = 8;
constexpr double hidden = 2.0;  // the delay, in steps, that a step of usual length may hide

}  // namespace

ArrivalSurveyor::Last ArrivalSurveyor::behind(const Last& before, std::int64_t t) const {
  Last last = before;
  last.t = t;
  ++last.count;
  // Before the first sample the longest pause is assumed whose delay could still be proven.
  if (before.count == 0) {
    last.first = t;
    last.step = step_;
    last.pause = static_cast<double>(reach) * step_;
    last.flush = true;
    return last;
  }
  last.step = static_cast<double>(t) - static_cast<double>(before.t);
  last.run = is_near(last.step) ? before.run + 1 : 0;
  if (shows_late(before, last.step)) {
    ++last.near;
    last.first_near = last.first_near || before.count == 1;
  }
  const bool heels = last.step <= flush_share * step_;
  last.flush = before.flush && heels && static_cast<double>(t - before.first) < flush_steps * step_;
  if (last.flush) return last;
  if (before.flush && heels) {  // too many samples for a flush, so the device measured faster
    last.near = 0;
    last.first_near = false;
  }
  const bool usual = std::abs(last.step - step_) < regular * step_;
  const double over = last.step - step_;
  last.pause =
      std::max(0.0, (before.flush ? 0.0 : before.pause) + over - (usual ? slack * step_ : 0.0));
  last.doubt = std::clamp(before.doubt + over, 0.0, least_late());
  // After a step of at least half a usual one, the sample may have waited without a visible pause.
  if (2.0 * last.step >= step_) last.doubt = std::max(last.doubt, hidden * step_);
  return last;
}

/// The sample's stamp relative to an ideal sequence whose step is 5 % shorter, ns. If a later
/// sample has a smaller value than an earlier sample, the difference is a lower bound of the
/// earlier sample's delay.
double ArrivalSurveyor::after_line(const Last& last) const {
  return static_cast<double>(last.t - last.first) -
         (1.0 - slack) * step_ * static_cast<double>(last.count - 1);
}

void ArrivalSurveyor::add(std::int64_t t) {
  if (!(step_ > 0.0)) return;
  settle();
  before_ = now_;
  now_ = behind(before_, t);
  settled_ = false;
}

/// Compares the last sample with earlier samples, once it can no longer be removed by take_back().
void ArrivalSurveyor::settle() {
  if (settled_) return;
  settled_ = true;
  if (!steady_) return;
  if (before_.flush && !now_.flush) {
    if (now_.step > flush_share * step_) find_late(after_line(before_));
    candidates_.clear();
  }
  const std::uint64_t index = now_.count - 1;
  // The delay of such an old candidate can't be proven any more.
  while (!candidates_.empty() && candidates_.front().index + reach < index) {
    candidates_.pop_front();
  }
  if (!now_.flush && now_.step < (1.0 - slack) * step_) find_late(after_line(now_));
  if (now_.pause >= least_late()) {
    candidates_.push_back({index, after_line(now_), now_.pause, false});
  }
}

/// Counts the candidates that the present sample proves to be late. `after_line` is that sample's
/// value.
void ArrivalSurveyor::find_late(double after_line) {
  for (Candidate& c : candidates_) {
    const double late = std::min(c.pause, c.after_line - after_line);
    if (late < least_late()) continue;
    late_.late += c.late ? 0 : 1;
    late_.first_late = late_.first_late || c.index == 0;
    c.late = true;
    late_.worst_late_ns = std::max<std::int64_t>(late_.worst_late_ns, std::llround(late));
  }
}

bool ArrivalSurveyor::shows_late(const Last& last, double step) const {
  if (!is_near(step)) return false;
  return (step < heap_share * step_ && last.run < heap) ||
         2.0 * std::max(last.pause, last.doubt) >= step_;
}

void ArrivalSurveyor::take_back() {
  now_ = before_;
  settled_ = true;
}

Arrivals ArrivalSurveyor::result() const {
  // The last sample may still be removed, so only a copy is settled.
  ArrivalSurveyor all = *this;
  all.settle();
  Arrivals found = all.late_;
  found.near = all.now_.near;
  found.near_only = step_ > 0.0 && !steady_;
  found.first_late = found.first_late || all.now_.first_near;
  return found;
}

}  // namespace kinalign
