// SPDX-License-Identifier: Apache-2.0
// What the stamps of a stream are like, from one pass in any number of pieces and fixed memory.
#pragma once

#include "kinalign/wire/time.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace kinalign {

struct StampSurvey {
  std::uint64_t samples = 0;     // all that were read
  std::uint64_t duplicates = 0;  // stamp equal to the last one kept
  std::uint64_t backward = 0;    // stamp before the last one kept
  std::int64_t largest_step_back_ns = 0;
  Time first{}, last{};             // of the samples kept
  std::int64_t median_step_ns = 0;  // between kept samples; 0 with fewer than two

  std::uint64_t kept() const { return samples - duplicates - backward; }
};

/// A stamp is kept where it is later than the last one kept; others are counted.
class StampSurveyor {
 public:
  void add(std::span<const Time> stamps);
  StampSurvey result() const;

 private:
  // Steps by size, 64 classes to each power of two of nanoseconds, and their sums: the median is
  // the mean of the middle class, exact for a steady rate and never off by more than 1 percent.
  static constexpr std::size_t classes = 64 * 64;
  StampSurvey survey_;
  std::array<std::uint64_t, classes> steps_{};
  std::array<double, classes> sums_{};
};

}  // namespace kinalign
