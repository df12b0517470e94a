// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/arrivals.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr std::uint64_t reach = 256;  // samples: how far behind one the proof is looked for
constexpr double slack = 0.05;        // of a step
constexpr double regular = 0.2;  // of a step: so much longer or shorter is no haste and no pause

}  // namespace

/// How late a sample can be that came `step` behind one that can be late by `pause`.
double ArrivalSurveyor::pause_behind(double pause, double step) const {
  const bool usual = std::abs(step - step_) < regular * step_;
  return std::max(0.0, pause + step - step_ - (usual ? slack * step_ : 0.0));
}

void ArrivalSurveyor::add(std::int64_t t) {
  found_before_ = found_;
  before_ = last_;
  if (count_ == 0) first_ = t;
  const double step = count_ == 0 ? step_ : static_cast<double>(t) - static_cast<double>(last_.t);
  if (!(step_ > 0.0)) return;
  if (static_cast<double>(near_share) * step < step_ && can_be_late()) {
    ++found_.near;
    found_.first_late = found_.first_late || count_ == 1;
  }
  const bool start = count_ == 0 || (last_.start && count_ < reach && step < step_);
  // In front of the first samples a pause of any length may have been.
  const double longest = static_cast<double>(reach) * step_;
  if (last_.start && !start)
    candidates_.clear();  // one came in time: those before it had not waited
  last_ = {t, start ? longest : pause_behind(last_.start ? 0.0 : last_.pause, step), start};
  const std::uint64_t index = count_++;

  const double after_line =
      static_cast<double>(t - first_) - (1.0 - slack) * step_ * static_cast<double>(index);
  while (!candidates_.empty() && candidates_.front().index + reach < index) {
    candidates_.pop_front();
  }
  const double least = static_cast<double>(late_steps) * step_;
  if (step < (1.0 - slack) * step_) find_late(after_line, least);
  if (last_.pause >= least) candidates_.push_back({index, after_line, last_.pause, false});
}

/// Of those that came behind a pause, by a sample that came in haste.
void ArrivalSurveyor::find_late(double after_line, double least) {
  for (Candidate& c : candidates_) {
    const double late = std::min(c.pause, c.after_line - after_line);
    if (late < least) continue;
    found_.late += c.late ? 0 : 1;
    found_.first_late = found_.first_late || c.index == 0;
    c.late = true;
    found_.worst_late_ns = std::max<std::int64_t>(found_.worst_late_ns, std::llround(late));
  }
}

bool ArrivalSurveyor::can_be_late() const { return count_ > 0 && 2.0 * last_.pause >= step_; }

void ArrivalSurveyor::take_back() {
  if (count_ == 0) return;
  --count_;
  last_ = before_;
  found_ = found_before_;
  if (!candidates_.empty() && candidates_.back().index == count_) candidates_.pop_back();
}

}  // namespace kinalign
