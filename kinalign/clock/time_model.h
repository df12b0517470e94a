// SPDX-License-Identifier: Apache-2.0
// From a device's stamps to the axis of a take, in pieces of a constant drift. Readers give one
// piece; what exchanges say of a node's clock is a HostFromNode, and no such model yet.
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

/// On stamps from `begin` on: take time = stamp + offset + drift * (stamp - begin).
struct TimeModelPiece {
  Time begin = Time::min();
  Duration offset{};       // take minus device at `begin`
  double drift_ppm = 0.0;  // rate of the device's clock against the take's
  /// Half-width of the interval that holds the true time: 0 where the clock is shared by
  /// construction, absent where nothing is known.
  std::optional<Duration> half_width;
};

/// Pieces in rising order of `begin`; the first one also serves what lies before it.
struct TimeModel {
  std::vector<TimeModelPiece> pieces{TimeModelPiece{}};
};

/// One clock for both: no offset, no doubt.
TimeModel shared_clock();

/// A stamp on the axis of the take.
Time take_time(const TimeModel& model, Time stamp);

/// The half-width that belongs to a stamp.
std::optional<Duration> half_width(const TimeModel& model, Time stamp);

/// Of any stamp one is known.
bool any_known(const TimeModel& model);

/// Half-widths as a take holds them, ns; this one where a stamp has none beside others that do.
inline constexpr std::int64_t no_interval = -1;
std::int64_t interval_ns(const TimeModel& model, Time stamp);

}  // namespace kinalign
