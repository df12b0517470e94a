// SPDX-License-Identifier: Apache-2.0
// Unwraps a device's own packet counter of 16 or 32 bits.
#pragma once

#include "kinalign/core/error.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace kinalign {

/// Continues a counter over its wraps.
/// Devices send 16 or 32 bits and wrap around. The count must go on, because stamps are computed
/// from it.
class PacketCount {
 public:
  /// Number of the packet among all packets. It is smaller than the last one if a packet arrived
  /// late. It leaps ahead if a counter value is wrong; the next counter then shows the error.
  /// StampRule handles both cases. Fails, without a place, if `cell` is no counter.
  Result<std::int64_t> next(double cell) {
    // The largest counter of 32 bits.
    constexpr double most = 4294967295.0;
    if (!(cell >= 0.0) || cell > most || cell != std::floor(cell)) {
      return Failure(Error{"", 0, "a whole number as PacketCounter", std::to_string(cell)});
    }
    const auto counter = static_cast<std::int64_t>(cell);
    // The packet before leapt ahead, and this one goes on from the count before it: the leap was a
    // wrong value.
    if (leapt_ && follows(counter, before_) && !follows(counter, now_)) now_ = before_;
    // One state back is enough: the next packet decides about a leap.
    before_ = now_;
    leapt_ = now_.rows > 0 && !follows(counter, now_);
    take(counter);
    return now_.place;
  }

  std::int64_t lost() const { return now_.lost; }
  /// The longest loss that is only a guess, because the counter fell. The device may have
  /// restarted.
  std::int64_t guessed() const { return now_.guessed; }

 private:
  /// Chosen: ten seconds at 100 Hz. No packet is later than that. A longer loss counts only if the
  /// next counter continues from it.
  static constexpr std::int64_t near = 1000;
  // A counter of 16 bits wraps at `narrow`, one of 32 bits at `wide`.
  static constexpr std::int64_t narrow = 65'536, wide = std::int64_t{1} << 32;

  /// `place`: number of the last packet; `highest`: the largest number so far.
  struct State {
    std::int64_t rows = 0, last = 0, place = 0, highest = 0, lost = 0, guessed = 0;
    std::int64_t wrap = narrow;  // `wide` once a counter has needed more than 16 bits
  };

  /// Step from the last counter to `counter`, by the shorter way around the wrap.
  static std::int64_t around(std::int64_t counter, const State& s) {
    // A counter above 16 bits can't have wrapped at 16 bits.
    const std::int64_t wrap = counter < narrow ? s.wrap : wide;
    const std::int64_t forward = ((counter - s.last) % wrap + wrap) % wrap;
    // A short way back is a late packet; everything else went forward.
    return wrap - forward <= near ? forward - wrap : forward;
  }
  static bool follows(std::int64_t counter, const State& s) {
    return std::abs(around(counter, s)) <= near;
  }

  void take(std::int64_t counter) {
    State& s = now_;
    // The first counter may be a wrong value. A counter that falls far behind it begins a new
    // count.
    const bool restarted = s.rows == 1 && counter < s.last && !follows(counter, s);
    const std::int64_t step = s.rows == 0 ? counter
                              : restarted ? counter - s.last
                                          : around(counter, s);
    if (restarted) {
      s.highest = counter - 1;
      s.wrap = narrow;
    }
    if (counter >= narrow) s.wrap = wide;
    // A lower counter with a long way forward: lost packets or a restart. Nothing tells them apart.
    if (s.rows > 0 && counter < s.last && step > near) s.guessed = std::max(s.guessed, step);
    s.place += step;
    s.last = counter;
    if (s.rows == 0 || s.place > s.highest) {
      // The numbers between the highest packet and this one have not arrived yet.
      s.lost += s.rows == 0 ? 0 : s.place - s.highest - 1;
      s.highest = s.place;
    } else if (s.lost > 0 && s.place < s.highest) {
      --s.lost;  // the packet was late, not lost
    }
    ++s.rows;
  }

  State now_, before_;
  bool leapt_ = false;  // the last packet leapt ahead of `before_`
};

}  // namespace kinalign
