// SPDX-License-Identifier: Apache-2.0
// Unwraps a device's own packet counter of 16 or 32 bits.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/wire/counter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace kinalign {

/// Continues a counter of 16 or 32 bits when it wraps around, because stamps are computed from the
/// count. The packets of a file are in order. A counter that falls has therefore wrapped, unless it
/// falls only a little: then the packet is late.
class PacketCount {
 public:
  /// The number of the packet among all packets. If a packet is late, its number is smaller than
  /// the previous one. If a counter is wrong, the number jumps ahead, and the next counter shows
  /// the error. StampRule handles both cases. Fails if `cell` is not a counter. The caller adds
  /// file and line to the error.
  Result<std::int64_t> next(double cell) {
    // The largest counter of 32 bits.
    constexpr double most = 4294967295.0;
    if (!(cell >= 0.0) || cell > most || cell != std::floor(cell)) {
      return Failure(Error{"", 0, "a whole number as PacketCounter", std::to_string(cell)});
    }
    const auto counter = static_cast<std::uint64_t>(cell);
    // The previous packet jumped ahead, and this packet continues the count before the jump. The
    // previous counter was therefore wrong.
    if (leapt_ && follows(counter, before_) && !follows(counter, now_)) now_ = before_;
    // One earlier state is enough, because the next packet shows whether a jump is real.
    before_ = now_;
    leapt_ = !follows(counter, now_);
    return take(counter);
  }

  std::uint64_t lost() const { return now_.numbers.missing(); }
  /// The longest possible loss that is uncertain, because the counter fell. The device may have
  /// restarted instead.
  std::int64_t guessed() const { return now_.guessed; }

 private:
  /// A chosen limit: ten seconds at 100 Hz. No packet is later than this. A longer loss counts only
  /// if the next counter continues from it.
  static constexpr std::int64_t near = 1000;

  struct State {
    Counter numbers;
    std::int64_t guessed = 0;
    unsigned bits = 16;  // 32 after a counter that needed more than 16 bits
  };

  /// The number of bits of the counter if this value is right.
  static unsigned bits_of(std::uint64_t counter, const State& s) {
    return counter >> 16 != 0 ? 32 : s.bits;
  }
  /// The number with this counter that is at most `near` before the newest number, or else after
  /// it.
  static std::int64_t number_of(std::uint64_t counter, const State& s) {
    if (s.numbers.empty()) return static_cast<std::int64_t>(counter);
    const unsigned bits = bits_of(counter, s);
    return unwrapped(counter, bits, s.numbers.newest() + (std::int64_t{1} << (bits - 1)) - near);
  }
  static bool follows(std::uint64_t counter, const State& s) {
    return s.numbers.empty() || s.numbers.steps_to(number_of(counter, s)) <= near;
  }

  std::int64_t take(std::uint64_t counter) {
    State& s = now_;
    const auto value = static_cast<std::int64_t>(counter);
    // The first counter may be wrong. If the second counter is far below it, a new count begins.
    const bool is_alone = s.numbers.first() == s.numbers.newest();
    if (is_alone && value < s.numbers.newest() && !follows(counter, s)) s = {};
    const std::int64_t number = number_of(counter, s);
    s.bits = bits_of(counter, s);
    const std::int64_t newest = s.numbers.newest(), steps = number - newest;
    // The counter wrapped, and the number is far ahead. Either many packets were lost, or the
    // device restarted.
    const bool fell = !s.numbers.empty() && number >> s.bits != newest >> s.bits;
    if (fell && steps > near) s.guessed = std::max(s.guessed, steps);
    const Counter::Place place = s.numbers.place_of(number);
    if (place == Counter::Place::ahead || place == Counter::Place::late) s.numbers.take(number);
    return number;
  }

  State now_, before_;
  bool leapt_ = false;  // the last packet jumped ahead of `before_`
};

}  // namespace kinalign
