// SPDX-License-Identifier: Apache-2.0
// Describes the stamps of a stream, in one pass over any number of pieces and with fixed memory.
#pragma once

#include "kinalign/wire/time.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

namespace kinalign {

/// The stamp of a frame at a fixed step. It is at most 4e18 ns (126 years) after the first one.
Time frame_stamp(Time first, double step_ns, std::uint64_t frame);

/// The stamp of a frame of a grid at a fixed rate.
inline Time grid_stamp(Time first, double rate_hz, std::uint64_t frame) {
  return first + Duration{std::llround(1e9 * static_cast<double>(frame) / rate_hz)};
}

/// The decision on a sample, from its stamp and the stamps before it.
enum class StampFate {
  kept,
  replaces,   // kept, and the last kept sample is removed: its stamp had jumped ahead
  duplicate,  // dropped: the stamp equals the last kept one
  backward    // dropped: the stamp is before the last kept one
};

/// Rising stamps are kept. A stamp is a clock error if it is more than four usual steps (at the
/// start: one second) after the previous one and also after the next one. It is then removed, so
/// that a single wrong stamp costs one sample and not all following ones. The first stamp has no
/// previous one; the second and third decide about it.
class StampRule {
 public:
  /// Decides on the next stamp of the stream.
  StampFate judge(Time stamp);
  /// True if the next sample may remove the last kept one.
  bool pending() const;

 private:
  void learn(std::uint64_t step);

  std::optional<Time> last_, before_;  // last two kept stamps
  std::uint64_t usual_step_ = 0;       // ns, from earlier steps; 0: not known yet
  std::optional<Time> withdrawn_;      // the first stamp, until the third shows whether it is right
};

struct StampSurvey {
  std::uint64_t samples = 0;     // all samples read
  std::uint64_t duplicates = 0;  // stamps equal to the last kept one
  std::uint64_t backward = 0;    // stamps before the last kept one
  std::uint64_t ahead = 0;       // stamps far ahead of the previous and of the next one
  std::int64_t largest_step_back_ns = 0;
  Time first{}, last{};             // among kept samples
  std::int64_t median_step_ns = 0;  // between kept samples; 0 with fewer than two
  std::uint64_t long_steps = 0;     // number of steps longer than 1.5 medians
  std::int64_t long_time_ns = 0;    // sum of these steps, during which the stream stood still
  /// The mean of the steps of at most 1.5 medians. Steps from 1/5 to 1/2 of a median are left out,
  /// because they occur while samples catch up after a stall. Shorter steps count: these samples
  /// were read at once.
  std::int64_t usual_step_ns = 0;
  std::uint64_t read_at_once = 0;  // steps shorter than a fifth of a median

  std::uint64_t kept() const { return samples - duplicates - backward - ahead; }
};

/// Counts the samples that StampRule keeps and drops.
class StampSurveyor {
 public:
  void add(std::span<const Time> stamps);
  StampSurvey result() const;

 private:
  void keep(Time stamp);
  void take_back();

  // A histogram of steps with 128 classes for each power of two of nanoseconds, and the sum of each
  // class. The median is the mean of the middle class: exact for a steady rate, and never wrong by
  // more than 1 percent.
  static constexpr std::size_t classes = 64 * 128;
  StampRule rule_;
  StampSurvey survey_;
  Time before_{};  // the last but one kept stamp
  std::array<std::uint64_t, classes> steps_{};
  std::array<double, classes> sums_{};
};

}  // namespace kinalign
