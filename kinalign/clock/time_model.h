// SPDX-License-Identifier: Apache-2.0
// Converts a device's stamps to the time axis of a take, in pieces of constant drift. File readers
// give a single piece. For a node, device_clock.h computes the pieces from its exchanges.
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

/// For stamps from `begin` on: time in the take = stamp + offset + drift * (stamp - begin).
struct TimeModelPiece {
  Time begin = Time::min();
  Duration offset{};       // take time minus device time, at `begin`
  double drift_ppm = 0.0;  // rate of the device's clock relative to the take's clock
  /// Half-width of the interval that contains the true time. 0: both clocks are the same clock.
  /// Absent: unknown.
  std::optional<Duration> half_width;
};

/// Pieces in rising order of `begin`. The first piece also applies to earlier stamps.
struct TimeModel {
  std::vector<TimeModelPiece> pieces{TimeModelPiece{}};
};

/// Returns the model of a device that uses the take's clock: no offset and a half-width of 0.
TimeModel shared_clock();

/// Converts the stamp to the take's time axis.
Time take_time(const TimeModel& model, Time stamp);

/// Returns the half-width of the time interval at a stamp.
std::optional<Duration> half_width(const TimeModel& model, Time stamp);

/// Returns whether at least one piece has a half-width.
bool any_known(const TimeModel& model);

/// Half-width in ns, as stored in a take; no_interval if it is unknown at this stamp.
inline constexpr std::int64_t no_interval = -1;
std::int64_t interval_ns(const TimeModel& model, Time stamp);

}  // namespace kinalign
