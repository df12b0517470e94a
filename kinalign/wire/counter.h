// SPDX-License-Identifier: Apache-2.0
// Numbers of n bits that a sender counts up and that wrap around: unwraps them, and tells which of
// them arrived. The window of numbers is that of RFC 4303 section 3.4.3.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace kinalign {

/// Steps from one number of `bits` bits (1 to 64) to another, by the shorter way around the wrap.
/// Negative: backwards.
constexpr std::int64_t steps_between(std::uint64_t from, std::uint64_t to, unsigned bits) {
  const unsigned unused = 64 - bits;
  return static_cast<std::int64_t>((to - from) << unused) >> unused;
}

/// The value of a number of `bits` bits that is nearest to `expected`.
constexpr std::int64_t unwrapped(std::uint64_t number, unsigned bits, std::int64_t expected) {
  const auto from = static_cast<std::uint64_t>(expected);
  const auto steps = static_cast<std::uint64_t>(steps_between(from, number, bits));
  return static_cast<std::int64_t>(from + steps);
}

/// Keeps which numbers arrived: the newest and the 1023 before it exactly, of the others only how
/// many. Takes 0.2 kB. Differences are computed modulo 2^64, so numbers of 64 bits may wrap, too.
class Counter {
 public:
  static constexpr std::int64_t window = 1024;

  /// a - b modulo 2^64, so numbers of 64 bits may wrap.
  static constexpr std::int64_t difference(std::int64_t a, std::int64_t b) {
    return steps_between(static_cast<std::uint64_t>(b), static_cast<std::uint64_t>(a), 64);
  }

  enum class Place : std::uint8_t {
    ahead,      // newer than all others, or the first one
    late,       // older than the newest, and did not arrive yet
    duplicate,  // it arrived before
    behind      // too old to know
  };

  /// Unwraps a number as sent to the value nearest to the newest. The first number stays as it is.
  constexpr std::int64_t unwrap(std::uint64_t sent, unsigned bits = 32) const {
    // The values nearest to the middle are the numbers themselves.
    return unwrapped(sent, bits, empty() ? std::int64_t{1} << (bits - 1) : newest_);
  }
  /// Judges an unwrapped number. Changes nothing.
  constexpr Place place_of(std::int64_t number) const {
    const std::int64_t steps = steps_to(number);
    if (empty() || steps > 0) return Place::ahead;
    if (steps <= -window) return Place::behind;
    const auto bits = static_cast<std::uint64_t>(number);
    return (seen_[word_of(bits)] & bit_of(bits)) != 0 ? Place::duplicate : Place::late;
  }
  /// Marks an unwrapped number as received. It must be ahead or late.
  constexpr void take(std::int64_t number) {
    if (empty()) first_ = newest_ = number;
    const std::int64_t steps = steps_to(number);
    // Skipped numbers did not arrive yet. Their bits belonged to numbers 1024 before.
    auto at = static_cast<std::uint64_t>(number);
    for (std::int64_t k = 0; k < std::min(steps, window); ++k, --at) {
      seen_[word_of(at)] &= ~bit_of(at);
    }
    at = static_cast<std::uint64_t>(number);
    seen_[word_of(at)] |= bit_of(at);
    if (steps > 0) newest_ = number;
    if (difference(number, first_) < 0) first_ = number;
    ++taken_;
  }

  constexpr bool empty() const { return taken_ == 0; }
  constexpr std::int64_t first() const { return first_; }  // the lowest number that arrived
  constexpr std::int64_t newest() const { return newest_; }
  /// Steps from the newest number to another one; negative: backwards.
  constexpr std::int64_t steps_to(std::int64_t number) const { return difference(number, newest_); }
  /// How many numbers between the first and the newest did not arrive.
  constexpr std::uint64_t missing() const {
    return empty() ? 0 : static_cast<std::uint64_t>(difference(newest_, first_)) + 1 - taken_;
  }

 private:
  static constexpr std::uint64_t bit_of(std::uint64_t number) {
    return std::uint64_t{1} << (number % 64);
  }
  static constexpr std::size_t word_of(std::uint64_t number) {
    return static_cast<std::size_t>(number / 64 % (window / 64));
  }

  std::array<std::uint64_t, window / 64> seen_{};  // a bit for each number, at number % 1024
  std::int64_t first_ = 0, newest_ = 0;
  std::uint64_t taken_ = 0;
};

}  // namespace kinalign
