// SPDX-License-Identifier: Apache-2.0
// The bounds of one direction of the last seconds, watched for a floor that has moved.
#pragma once

#include "kinalign/clock/live/floor.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace kinalign {

/// Where a bound lies when it comes, by the floor as it is known then.
enum class Standing : std::uint8_t {
  held,   // so far below that it is kept out of the route until more is known
  usual,  // near the floor
  above   // clearly above, as it is for a delayed packet, and for each of a longer route
};

class RecentBounds {
 public:
  void add(OffsetBound bound, Standing standing);

  /// If all of the last second (or three, or nine) lie around another floor than `line`: the moment
  /// between the last one of the old floor and the first of the new. `counts`: how the excess lies
  /// that was seen on the old floor. Found within a few bounds.
  std::optional<double> moved(const FloorLine& line, const ExcessCounts& counts) const;

  /// Whether fewer came around s than usually do: the longest step over it against the mean one.
  bool silent_around(double s) const;

  /// The moment before the first held bound.
  std::optional<double> before_held() const;

  /// A held bound that nothing followed within nine seconds: it is taken for one of the route.
  std::optional<OffsetBound> release(double s);

  /// How many of the newest came behind s.
  std::size_t behind(double s) const;
  const OffsetBound& newest(std::size_t i) const { return entry(i).bound; }  // 0: the last one

 private:
  struct Entry {
    OffsetBound bound;
    Standing standing = Standing::usual;
  };
  static constexpr std::size_t capacity = 256;
  const Entry& entry(std::size_t newest) const {
    return entries_[(next_ + capacity - 1 - newest) % capacity];
  }
  /// Of some of the newest: how many, and the least delay above a floor.
  struct Level {
    std::size_t points = 0;
    double least = 0.0;
  };
  bool another_floor(const Level& level, double window_s, const FloorLine& line,
                     const ExcessCounts& counts) const;
  double before(std::size_t newest) const;

  std::array<Entry, capacity> entries_{};
  std::size_t next_ = 0, size_ = 0;
  std::size_t above_run_ = 0;   // newest in a row that stand above
  std::size_t since_held_ = 0;  // newest since the first held one; 0: none is
};

}  // namespace kinalign
