// SPDX-License-Identifier: Apache-2.0
// Keeps the bounds of one direction over the last seconds and finds a floor that has moved.
#pragma once

#include "kinalign/clock/live/floor.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace kinalign {

/// Position of a bound on arrival, relative to the floor as it is known then.
enum class Standing : std::uint8_t {
  held,   // far below: kept out of the route until more is known
  usual,  // near the floor
  above   // clearly above, as for a delayed packet or for every packet of a longer route
};

class RecentBounds {
 public:
  void add(OffsetBound bound, Standing standing);

  /// Finds a new floor: all bounds of the last second (or three, or nine) lie around another line
  /// than `line`. Returns the moment between the last bound of the old floor and the first of the
  /// new. `counts`: histogram of the delays on the old floor. Detects a change within a few bounds.
  std::optional<double> moved(const FloorLine& line, const ExcessCounts& counts) const;

  /// True if there is an unusually long gap around s, compared with the mean gap.
  bool silent_around(double s) const;

  /// The moment before the first bound of standing `held`.
  std::optional<double> before_held() const;

  /// Returns a bound of standing `held` if it did not start a new floor within nine seconds: it
  /// then counts as one of the route.
  std::optional<OffsetBound> release(double s);

  /// Number of the newest bounds that come after s.
  std::size_t behind(double s) const;
  const OffsetBound& newest(std::size_t i) const { return entry(i).bound; }  // 0: the latest one

 private:
  struct Entry {
    OffsetBound bound;
    Standing standing = Standing::usual;
  };
  static constexpr std::size_t capacity = 256;
  const Entry& entry(std::size_t newest) const {
    return entries_[(next_ + capacity - 1 - newest) % capacity];
  }
  /// Some of the newest bounds: their number, and their least delay above a floor.
  struct Level {
    std::size_t points = 0;
    double least = 0.0;
  };
  bool another_floor(const Level& level, double window_s, const FloorLine& line,
                     const ExcessCounts& counts) const;
  double before(std::size_t newest) const;

  std::array<Entry, capacity> entries_{};
  std::size_t next_ = 0, size_ = 0;
  std::size_t above_run_ = 0;   // number of newest bounds in a row that stand above
  std::size_t since_held_ = 0;  // number of newest bounds since the first held one; 0: none is held
};

}  // namespace kinalign
