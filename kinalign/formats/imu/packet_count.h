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

/// Continues a counter over its wraps.
/// Devices send 16 or 32 bits and wrap around. The count must go on, because stamps are computed
/// from it. A file is written in order, so a counter that falls has wrapped; only a short way back
/// is a late packet.
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
    const auto counter = static_cast<std::uint64_t>(cell);
    // The packet before leapt ahead, and this one goes on from the count before it: the leap was a
    // wrong value.
    if (leapt_ && follows(counter, before_) && !follows(counter, now_)) now_ = before_;
    // One state back is enough: the next packet decides about a leap.
    before_ = now_;
    leapt_ = !follows(counter, now_);
    return take(counter);
  }

  std::uint64_t lost() const { return now_.numbers.missing(); }
  /// The longest loss that is only a guess, because the counter fell. The device may have
  /// restarted.
  std::int64_t guessed() const { return now_.guessed; }

 private:
  /// Chosen: ten seconds at 100 Hz. No packet is later than that. A longer loss counts only if the
  /// next counter continues from it.
  static constexpr std::int64_t near = 1000;

  struct State {
    Counter numbers;
    std::int64_t guessed = 0;
    unsigned bits = 16;  // 32 once a counter has needed more than 16 bits
  };

  /// How many bits the counter has, if this value is right.
  static unsigned bits_of(std::uint64_t counter, const State& s) {
    return counter >> 16 != 0 ? 32 : s.bits;
  }
  /// The number at most `near` before the newest one, or else after it.
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
    // The first counter may be a wrong value. If the second one is far below it, it begins a new
    // count.
    const bool is_alone = s.numbers.first() == s.numbers.newest();
    if (is_alone && value < s.numbers.newest() && !follows(counter, s)) s = {};
    const std::int64_t number = number_of(counter, s);
    s.bits = bits_of(counter, s);
    const std::int64_t newest = s.numbers.newest(), steps = number - newest;
    // Another turn, and a long way: lost packets or a restart. Nothing tells them apart.
    const bool fell = !s.numbers.empty() && number >> s.bits != newest >> s.bits;
    if (fell && steps > near) s.guessed = std::max(s.guessed, steps);
    const Counter::Place place = s.numbers.place_of(number);
    if (place == Counter::Place::ahead || place == Counter::Place::late) s.numbers.take(number);
    return number;
  }

  State now_, before_;
  bool leapt_ = false;  // the last packet leapt ahead of `before_`
};

}  // namespace kinalign
