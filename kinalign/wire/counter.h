// SPDX-License-Identifier: Apache-2.0
// A sender numbers its packets with n bits, and the numbers wrap around. This file unwraps the
// numbers and keeps which of them arrived. The window of exactly known numbers follows RFC 4303
// section 3.4.3.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace kinalign {

/// The difference between two numbers of `bits` bits (1 to 64), by the shorter way around the wrap.
/// It is negative if `to` is behind `from`.
constexpr std::int64_t steps_between(std::uint64_t from, std::uint64_t to, unsigned bits) {
  const unsigned unused = 64 - bits;
  return static_cast<std::int64_t>((to - from) << unused) >> unused;
}

/// Among all values that end in the same `bits` bits as `number`: the value nearest to `expected`.
constexpr std::int64_t unwrapped(std::uint64_t number, unsigned bits, std::int64_t expected) {
  const auto from = static_cast<std::uint64_t>(expected);
  const auto steps = static_cast<std::uint64_t>(steps_between(from, number, bits));
  return static_cast<std::int64_t>(from + steps);
}

/// Keeps which numbers arrived. The newest number and the 1023 numbers before it are kept exactly;
/// older ones are only counted. A Counter takes 0.2 kB. Differences are computed modulo 2^64, so
/// numbers of 64 bits may wrap, too.
class Counter {
 public:
  static constexpr std::int64_t window = 1024;

  /// a - b modulo 2^64, so numbers of 64 bits may wrap.
  static constexpr std::int64_t difference(std::int64_t a, std::int64_t b) {
    return steps_between(static_cast<std::uint64_t>(b), static_cast<std::uint64_t>(a), 64);
  }

  enum class Place : std::uint8_t {
    ahead,      // newer than all others, or the first number
    late,       // older than the newest, and did not arrive before
    duplicate,  // it arrived before
    behind      // too old: not known whether it arrived
  };

  /// Unwraps a number to the value nearest to the newest number. The first number stays as it is.
  constexpr std::int64_t unwrap(std::uint64_t sent, unsigned bits = 32) const {
    // A number is the nearest value to the middle of its own range, so the first number is
    // unchanged.
    return unwrapped(sent, bits, empty() ? std::int64_t{1} << (bits - 1) : newest_);
  }
  /// Classifies an unwrapped number and changes nothing.
  constexpr Place place_of(std::int64_t number) const {
    const std::int64_t steps = steps_to(number);
    if (empty() || steps > 0) return Place::ahead;
    if (steps <= -window) return Place::behind;
    const auto bits = static_cast<std::uint64_t>(number);
    return (seen_[word_of(bits)] & bit_of(bits)) != 0 ? Place::duplicate : Place::late;
  }
  /// Marks an unwrapped number as received. Its place must be `ahead` or `late`.
  constexpr void take(std::int64_t number) {
    if (empty()) first_ = newest_ = number;
    const std::int64_t steps = steps_to(number);
    // The skipped numbers have not arrived yet. Their bits were those of the numbers 1024 earlier.
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
  /// The difference between a number and the newest one; negative for an older number.
  constexpr std::int64_t steps_to(std::int64_t number) const { return difference(number, newest_); }
  /// The count of numbers between the first and the newest that did not arrive.
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
