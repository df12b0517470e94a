// SPDX-License-Identifier: Apache-2.0
// What the stamps of a stream are like, from one pass in any number of pieces and fixed memory.
#pragma once

#include "kinalign/wire/time.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace kinalign {

/// The stamp of a frame of a fixed step. Later than 4e18 ns after the first, 126 years, is none.
Time frame_stamp(Time first, double step_ns, std::uint64_t frame);

/// What becomes of a sample, by its stamp and the ones before it.
enum class StampFate {
  kept,
  replaces,   // kept, and the last one kept is taken back: it had jumped ahead of this one
  duplicate,  // left out: the stamp of the last one kept
  backward    // left out: a stamp before the last one kept
};

/// Rising stamps are kept. One that leads the one before by more than four usual steps (at first: a
/// second) and the next one by anything is a slip of the clock and is taken back, so that a single
/// wild stamp costs a single sample and not all that follow. Of the first stamp, which has none
/// before it, the second and third decide.
class StampRule {
 public:
  StampFate judge(Time stamp);
  /// Whether the next sample may take the last one kept back.
  bool pending() const;

 private:
  void learn(std::uint64_t step);

  std::optional<Time> last_, before_;  // kept
  std::uint64_t usual_step_ = 0;       // ns, of the ones before; 0: not known yet
  std::optional<Time> withdrawn_;      // the first one, until the third says who was wrong
};

struct StampSurvey {
  std::uint64_t samples = 0;     // all that were read
  std::uint64_t duplicates = 0;  // stamp equal to the last one kept
  std::uint64_t backward = 0;    // stamp before the last one kept
  std::uint64_t ahead = 0;       // stamp far ahead of the ones before and behind
  std::int64_t largest_step_back_ns = 0;
  Time first{}, last{};             // of the samples kept
  std::int64_t median_step_ns = 0;  // between kept samples; 0 with fewer than two
  std::uint64_t long_steps = 0;     // of these, longer than 1.5 medians
  std::int64_t long_time_ns = 0;    // in which the stream stood still: their sum
  /// The mean of those up to one and a half medians, without the haste behind a stall, from a fifth
  /// to half a median. Shorter ones are of samples that were read at once.
  std::int64_t usual_step_ns = 0;
  std::uint64_t read_at_once = 0;  // steps shorter than a fifth of a median

  std::uint64_t kept() const { return samples - duplicates - backward - ahead; }
};

/// Counts what StampRule keeps and leaves out.
class StampSurveyor {
 public:
  void add(std::span<const Time> stamps);
  StampSurvey result() const;

 private:
  void keep(Time stamp);
  void take_back();

  // Steps by size, 128 classes to each power of two of nanoseconds, and their sums: the median is
  // the mean of the middle class, exact for a steady rate and never off by more than 1 percent.
  static constexpr std::size_t classes = 64 * 128;
  StampRule rule_;
  StampSurvey survey_;
  Time before_{};  // the last stamp kept but one
  std::array<std::uint64_t, classes> steps_{};
  std::array<double, classes> sums_{};
};

}  // namespace kinalign
