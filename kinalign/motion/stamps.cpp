// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/stamps.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace kinalign {

namespace {

// The class of a step > 0: the number of its leading bit, followed by the next seven bits.
std::size_t class_of(std::uint64_t step) {
  const auto bits = static_cast<unsigned>(std::bit_width(step | 1)) - 1;
  const std::uint64_t fraction = bits >= 7 ? step >> (bits - 7) : step << (7 - bits);
  return (std::size_t{bits} << 7) + (fraction & 127);
}

// Nanoseconds. If the first step is longer, the stamp may be a clock error.
constexpr std::uint64_t longest_first = 1'000'000'000;
// If a later step is longer than this many usual steps, the stamp may be a clock error.
constexpr std::uint64_t longest_ratio = 4;

// llround() of a larger number is undefined.
std::int64_t rounded(double ns) { return ns < 9.2e18 ? std::llround(ns) : INT64_MAX; }

std::int64_t held(std::uint64_t ns) {
  return static_cast<std::int64_t>(std::min<std::uint64_t>(ns, INT64_MAX));
}

}  // namespace

Time frame_stamp(Time first, double step_ns, std::uint64_t frame) {
  constexpr double largest = 4e18;
  return first + Duration{std::llround(std::min(static_cast<double>(frame) * step_ns, largest))};
}

StampFate StampRule::judge(Time stamp) {
  if (!last_) {
    last_ = stamp;
    return StampFate::kept;
  }
  if (stamp == *last_) return StampFate::duplicate;
  if (stamp > *last_) {
    const bool first_was_right = withdrawn_ && stamp > *withdrawn_;
    if (!first_was_right) {
      if (before_) learn(step_between(*before_, *last_));
      before_ = last_;
    }
    withdrawn_.reset();
    last_ = stamp;
    return first_was_right ? StampFate::replaces : StampFate::kept;
  }
  // The second stamp is more than a second before the first one. The third one shows which of the
  // two is wrong.
  const bool first_leads = !before_ && !withdrawn_ && step_between(stamp, *last_) > longest_first;
  if (first_leads) withdrawn_ = last_;
  if (!first_leads && !(before_ && stamp > *before_ && pending())) return StampFate::backward;
  last_ = stamp;
  return StampFate::replaces;
}

/// The usual step follows shorter steps at once and longer steps slowly, so that a single gap does
/// not make a clock error look usual.
void StampRule::learn(std::uint64_t step) {
  constexpr std::uint64_t countable = std::uint64_t{1} << 60;
  step = std::min(step, countable);
  usual_step_ = usual_step_ == 0 ? step : std::min(step, 2 * usual_step_);
}

bool StampRule::pending() const {
  if (!last_ || !before_) return last_.has_value();
  const std::uint64_t step = step_between(*before_, *last_);
  return step > (usual_step_ == 0 ? longest_first : longest_ratio * usual_step_);
}

void StampSurveyor::keep(Time stamp) {
  if (survey_.kept() == 1) {
    survey_.first = stamp;
  } else {
    const std::uint64_t step = step_between(survey_.last, stamp);
    ++steps_[class_of(step)];
    sums_[class_of(step)] += static_cast<double>(step);
  }
  before_ = survey_.last;
  survey_.last = stamp;
}

/// Removes the last kept stamp; the counts are already updated.
void StampSurveyor::take_back() {
  if (survey_.kept() > 1) {
    const std::uint64_t step = step_between(before_, survey_.last);
    --steps_[class_of(step)];
    sums_[class_of(step)] -= static_cast<double>(step);
  }
  survey_.last = before_;
}

void StampSurveyor::add(std::span<const Time> stamps) {
  for (const Time stamp : stamps) {
    const Time last = survey_.last;
    const StampFate fate = rule_.judge(stamp);
    ++survey_.samples;
    if (fate == StampFate::duplicate) ++survey_.duplicates;
    const bool steps_back = stamp < last && survey_.samples > 1;
    if (fate == StampFate::backward || (fate == StampFate::replaces && !steps_back)) {
      ++survey_.backward;
    }
    if (fate == StampFate::backward) {
      survey_.largest_step_back_ns =
          std::max(survey_.largest_step_back_ns, held(step_between(stamp, last)));
    }
    if (fate == StampFate::replaces) {
      survey_.ahead += steps_back ? 1 : 0;
      take_back();
    }
    if (fate == StampFate::kept || fate == StampFate::replaces) keep(stamp);
  }
}

StampSurvey StampSurveyor::result() const {
  StampSurvey survey = survey_;
  // The median is in the class that contains the middle step.
  std::uint64_t all = 0;
  for (const auto n : steps_) all += n;
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < classes && all > 0; ++i) {
    below += steps_[i];
    if (2 * below >= all) {
      const double middle = sums_[i] / static_cast<double>(steps_[i]);
      survey.median_step_ns = rounded(middle);
      break;
    }
  }
  const auto median = static_cast<double>(survey.median_step_ns);
  double long_time = 0.0, usual_time = 0.0;
  std::uint64_t usual = 0;
  for (std::size_t i = 0; i < classes; ++i) {
    const double step = sums_[i] / static_cast<double>(std::max<std::uint64_t>(1, steps_[i]));
    if (step > 1.5 * median) {
      survey.long_steps += steps_[i];
      long_time += sums_[i];
    } else if (2.0 * step >= median || 5.0 * step < median) {
      survey.read_at_once += 5.0 * step < median ? steps_[i] : 0;
      usual += steps_[i];
      usual_time += sums_[i];
    }
  }
  survey.long_time_ns = rounded(long_time);
  if (usual > 0) survey.usual_step_ns = rounded(usual_time / static_cast<double>(usual));
  return survey;
}

}  // namespace kinalign
