// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/stamps.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace kinalign {

namespace {

// Class of a step > 0: the six bits behind its leading one, below the number of that bit.
std::size_t class_of(std::uint64_t step) {
  const auto bits = static_cast<unsigned>(std::bit_width(step)) - 1;
  const std::uint64_t fraction = bits >= 6 ? step >> (bits - 6) : step << (6 - bits);
  return (std::size_t{bits} << 6) + (fraction & 63);
}

/// later - earlier, also where that is more than a Duration holds.
std::uint64_t step_between(Time earlier, Time later) {
  return static_cast<std::uint64_t>(to_ns(later)) - static_cast<std::uint64_t>(to_ns(earlier));
}

std::int64_t held(std::uint64_t ns) {
  return static_cast<std::int64_t>(std::min<std::uint64_t>(ns, INT64_MAX));
}

}  // namespace

void StampSurveyor::add(std::span<const Time> stamps) {
  for (const Time stamp : stamps) {
    const bool first = survey_.samples++ == 0;
    if (first) {
      survey_.first = survey_.last = stamp;
      continue;
    }
    if (stamp == survey_.last) {
      ++survey_.duplicates;
    } else if (stamp < survey_.last) {
      ++survey_.backward;
      survey_.largest_step_back_ns =
          std::max(survey_.largest_step_back_ns, held(step_between(stamp, survey_.last)));
    } else {
      const std::uint64_t step = step_between(survey_.last, stamp);
      ++steps_[class_of(step)];
      sums_[class_of(step)] += static_cast<double>(step);
      survey_.last = stamp;
    }
  }
}

StampSurvey StampSurveyor::result() const {
  StampSurvey survey = survey_;
  std::uint64_t all = 0;
  for (const auto n : steps_) all += n;
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < classes && all > 0; ++i) {
    below += steps_[i];
    if (2 * below >= all) {
      const double middle = sums_[i] / static_cast<double>(steps_[i]);
      survey.median_step_ns = held(static_cast<std::uint64_t>(middle + 0.5));
      break;
    }
  }
  return survey;
}

}  // namespace kinalign
