// SPDX-License-Identifier: Apache-2.0
// Stores the bounds of one direction over the last seconds and finds out whether the floor has
// moved. The floor is the least delay of the direction (docs/clock.md).
#pragma once

#include "kinalign/clock/live/floor.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace kinalign {

/// Position of a bound relative to the floor that is known when the bound arrives.
enum class Standing : std::uint8_t {
  held,   // far below the floor: not added to the route until more bounds arrive
  usual,  // near the floor
  above   // clearly above, like a delayed packet or each packet of a longer route
};

class RecentBounds {
 public:
  void add(OffsetBound bound, Standing standing);

  /// Looks for a new floor: all bounds of the last second (or three, or nine) lie near another line
  /// than `line`. Returns the moment between the last bound of the old floor and the first bound of
  /// the new floor. `counts`: histogram of the delays on the old floor. Detects a change within a
  /// few bounds.
  std::optional<double> moved(const FloorLine& line, const ExcessCounts& counts) const;

  /// Returns whether the gap around s is unusually long compared with the mean gap.
  bool silent_around(double s) const;

  /// The moment before the first bound of standing `held`.
  std::optional<double> before_held() const;

  /// Returns a bound of standing `held` if no new floor began with it within nine seconds. The
  /// bound then belongs to the route.
  std::optional<OffsetBound> release(double s);

  /// Number of bounds after s.
  std::size_t behind(double s) const;
  const OffsetBound& newest(std::size_t i) const { return entry(i).bound; }  // 0: the newest bound

 private:
  struct Entry {
    OffsetBound bound;
    Standing standing = Standing::usual;
  };
  static constexpr std::size_t capacity = 256;
  const Entry& entry(std::size_t newest) const {
    return entries_[(next_ + capacity - 1 - newest) % capacity];
  }
  /// Some of the newest bounds: their number and the least of their delays above a floor.
  struct Level {
    std::size_t points = 0;
    double least = 0.0;
  };
  bool another_floor(const Level& level, double window_s, const FloorLine& line,
                     const ExcessCounts& counts) const;
  double before(std::size_t newest) const;

  std::array<Entry, capacity> entries_{};
  std::size_t next_ = 0, size_ = 0;
  std::size_t above_run_ = 0;   // number of newest bounds in a row that are `above`
  std::size_t since_held_ = 0;  // number of bounds since the first held bound; 0: no bound is held
};

}  // namespace kinalign
