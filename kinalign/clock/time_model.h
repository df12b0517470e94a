// SPDX-License-Identifier: Apache-2.0
// Maps a device's stamps to the axis of a take, in pieces of constant drift. Readers give a single
// piece. The exchanges of a node give a HostFromNode first, which device_clock.h converts.
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

/// For stamps from `begin` on: take time = stamp + offset + drift * (stamp - begin).
struct TimeModelPiece {
  Time begin = Time::min();
  Duration offset{};       // take minus device, at `begin`
  double drift_ppm = 0.0;  // rate of the device's clock against that of the take
  /// Half-width of the interval that holds the true time. 0: both clocks are the same by
  /// construction; absent: unknown.
  std::optional<Duration> half_width;
};

/// Pieces in rising order of `begin`. The first one also applies to earlier stamps.
struct TimeModel {
  std::vector<TimeModelPiece> pieces{TimeModelPiece{}};
};

/// The model of a device that uses the take's clock: no offset, and a half-width of 0.
TimeModel shared_clock();

/// The stamp on the take's axis.
Time take_time(const TimeModel& model, Time stamp);

/// The half-width at a stamp.
std::optional<Duration> half_width(const TimeModel& model, Time stamp);

/// True if the half-width is known in at least one piece.
bool any_known(const TimeModel& model);

/// Half-width in ns as a take stores it; no_interval if it is unknown at this stamp.
inline constexpr std::int64_t no_interval = -1;
std::int64_t interval_ns(const TimeModel& model, Time stamp);

}  // namespace kinalign
