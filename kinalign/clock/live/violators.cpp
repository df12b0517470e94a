// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/live/violators.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr std::uint64_t few_crossings = 8;  // limit for a node that sends rarely
constexpr double latest_s = 1.0;  // a crossing that is this late may be from before a step

}  // namespace

// Between two bounds the offset can change at most by the greatest rate times their distance.
bool contradict(const Bound& a, const Bound& b, double rate) {
  if (a.side == b.side) return false;
  const Bound& above = a.side == Side::above ? a : b;
  const Bound& below = a.side == Side::above ? b : a;
  return below.x > above.x + rate * std::abs(a.s - b.s) + Violators::tolerated_s;
}

void Violators::add(const Violator& violator) { violators_[count_++] = violator; }

void Violators::drop_excluded_by(const Bound& taken, double rate) {
  const auto end = violators_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto kept = std::remove_if(violators_.begin(), end, [&](const Violator& v) {
    return taken.s > v.bound.s + latest_s && contradict(taken, v.bound, rate);
  });
  count_ = static_cast<std::size_t>(kept - violators_.begin());
}

bool Violators::overdue(HostTime now, std::uint64_t crossings) const {
  return count_ > 0 && now - violators_[0].crossing.arrival > wait &&
         crossings - violators_[0].number > few_crossings;
}

}  // namespace kinalign
