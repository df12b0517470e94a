// SPDX-License-Identifier: Apache-2.0
// Tracks which sequence numbers of a sender were received: the newest and the 1023 before it, as
// RFC 4303 section 3.4.3 does against replays. Numbers are widened to 64 bits, so they never wrap.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>

namespace kinalign {

/// `place_of` changes nothing, so sessions can be compared by it before one of them takes the
/// number.
class SequenceWindow {
 public:
  static constexpr std::size_t size = 1024;

  enum class Place : std::uint8_t { fresh, seen, behind };

  /// Judges a number as sent, modulo 2^32. It is widened to the value nearest to the newest.
  Place place_of(std::uint32_t sequence) const;
  /// Marks a number as received. Call only after `fresh`. Returns the widened number.
  std::uint64_t take(std::uint32_t sequence);

  bool empty() const { return !begun_; }
  /// Returns whether the number is newer than all received ones.
  bool is_ahead(std::uint32_t sequence) const { return !begun_ || steps_to(sequence) > 0; }
  std::uint64_t first() const { return first_; }
  std::uint64_t newest() const { return newest_; }
  /// Numbers not received between the first and the newest.
  std::uint64_t missing() const { return begun_ ? newest_ - first_ + 1 - taken_ : 0; }

 private:
  std::int64_t steps_to(std::uint32_t sequence) const;

  std::bitset<size> seen_;  // by number modulo size
  std::uint64_t first_ = 0, newest_ = 0, taken_ = 0;
  bool begun_ = false;
};

}  // namespace kinalign
