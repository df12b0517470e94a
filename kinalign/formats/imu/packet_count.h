// SPDX-License-Identifier: Apache-2.0
// A device's own count of its packets, in 16 bits or 32.
#pragma once

#include "kinalign/core/error.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace kinalign {

/// Counts on over a counter's wraps.
class PacketCount {
 public:
  /// The packet's place among all. It falls where a packet was overtaken by the next, and leads by
  /// far where a counter is wild, which the one behind it shows; StampRule knows both. Fails,
  /// without a place, on what is no counter.
  Result<std::int64_t> next(double cell) {
    constexpr double most = 4294967295.0;
    if (!(cell >= 0.0) || cell > most || cell != std::floor(cell)) {
      return Failure(Error{"", 0, "a whole PacketCounter", std::to_string(cell)});
    }
    const auto counter = static_cast<std::int64_t>(cell);
    if (leapt_ && follows(counter, before_) && !follows(counter, now_)) now_ = before_;
    before_ = now_;
    leapt_ = now_.rows > 0 && !follows(counter, now_);
    take(counter);
    return now_.place;
  }

  std::int64_t lost() const { return now_.lost; }
  /// The longest loss that is only guessed, since the counter fell: a device that began anew?
  std::int64_t guessed() const { return now_.guessed; }

 private:
  /// Chosen: ten seconds at 100 Hz. A packet is not overtaken by more, and a longer loss is
  /// believed only when the next counter goes on from it.
  static constexpr std::int64_t near = 1000;
  static constexpr std::int64_t narrow = 65'536, wide = std::int64_t{1} << 32;

  struct State {
    std::int64_t rows = 0, last = 0, place = 0, highest = 0, lost = 0, guessed = 0;
    std::int64_t wrap = narrow;  // wide where a counter has shown more than 16 bits
  };

  /// How far `counter` lies behind the last one, on the shorter way around.
  static std::int64_t around(std::int64_t counter, const State& s) {
    const std::int64_t wrap = counter < narrow ? s.wrap : wide;
    const std::int64_t forward = ((counter - s.last) % wrap + wrap) % wrap;
    return wrap - forward <= near ? forward - wrap : forward;
  }
  static bool follows(std::int64_t counter, const State& s) {
    return std::abs(around(counter, s)) <= near;
  }

  void take(std::int64_t counter) {
    State& s = now_;
    // The first counter may be the wild one: what falls behind it counts anew.
    const bool anew = s.rows == 1 && counter < s.last && !follows(counter, s);
    const std::int64_t step = s.rows == 0 ? counter : anew ? counter - s.last : around(counter, s);
    if (anew) {
      s.highest = counter - 1;
      s.wrap = narrow;
    }
    if (counter >= narrow) s.wrap = wide;
    if (s.rows > 0 && counter < s.last && step > near) s.guessed = std::max(s.guessed, step);
    s.place += step;
    s.last = counter;
    if (s.rows == 0 || s.place > s.highest) {
      s.lost += s.rows == 0 ? 0 : s.place - s.highest - 1;
      s.highest = s.place;
    } else if (s.lost > 0 && s.place < s.highest) {
      --s.lost;  // it was only late
    }
    ++s.rows;
  }

  State now_, before_;
  bool leapt_ = false;  // the last one, out of what `before_` was
};

}  // namespace kinalign
