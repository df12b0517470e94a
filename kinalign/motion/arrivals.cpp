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
  before_ = now_;
  State& s = now_;
  if (s.count == 0) s.first = t;
  const double step = s.count == 0 ? step_ : static_cast<double>(t) - static_cast<double>(s.last);
  if (!(step_ > 0.0)) return;
  if (static_cast<double>(near_share) * step < step_ && can_be_late()) {
    ++s.found.near;
    s.found.first_late = s.found.first_late || s.count == 1;
  }
  const bool start = s.count == 0 || (s.start && s.count < reach && step < step_);
  // In front of the first samples a pause of any length may have been.
  const double longest = static_cast<double>(reach) * step_;
  if (s.start && !start) s.candidates.clear();  // one came in time: those before it had not waited
  s.pause = start ? longest : pause_behind(s.start ? 0.0 : s.pause, step);
  s.start = start;
  s.last = t;
  const std::uint64_t index = s.count++;

  const double after_line =
      static_cast<double>(t - s.first) - (1.0 - slack) * step_ * static_cast<double>(index);
  while (!s.candidates.empty() && s.candidates.front().index + reach < index) {
    s.candidates.pop_front();
  }
  const double least = static_cast<double>(late_steps) * step_;
  if (step < (1.0 - slack) * step_) find_late(after_line, least);
  if (s.pause >= least) s.candidates.push_back({index, after_line, s.pause, false});
}

/// Of those that came behind a pause, by a sample that came in haste.
void ArrivalSurveyor::find_late(double after_line, double least) {
  Arrivals& found = now_.found;
  for (Candidate& c : now_.candidates) {
    const double late = std::min(c.pause, c.after_line - after_line);
    if (late < least) continue;
    found.late += c.late ? 0 : 1;
    found.first_late = found.first_late || c.index == 0;
    c.late = true;
    found.worst_late_ns = std::max<std::int64_t>(found.worst_late_ns, std::llround(late));
  }
}

bool ArrivalSurveyor::can_be_late() const { return now_.count > 0 && 2.0 * now_.pause >= step_; }

void ArrivalSurveyor::take_back() { now_ = before_; }

}  // namespace kinalign
