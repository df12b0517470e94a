// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/time_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace kinalign {

namespace {

const TimeModelPiece& piece_at(const TimeModel& model, Time stamp) {
  assert(!model.pieces.empty());
  const auto behind =
      std::upper_bound(model.pieces.begin(), model.pieces.end(), stamp,
                       [](Time t, const TimeModelPiece& piece) { return t < piece.begin; });
  return behind == model.pieces.begin() ? model.pieces.front() : *(behind - 1);
}

/// Returns ns as a double, because the difference of two stamps may be longer than a Duration.
double since(Time begin, Time stamp) {
  return stamp < begin ? -static_cast<double>(step_between(stamp, begin))
                       : static_cast<double>(step_between(begin, stamp));
}

}  // namespace

TimeModel shared_clock() {
  TimeModel model;
  model.pieces.front().half_width = Duration{0};
  return model;
}

Time take_time(const TimeModel& model, Time stamp) {
  const TimeModelPiece& piece = piece_at(model, stamp);
  Duration drifted{};
  if (piece.drift_ppm != 0.0) {
    drifted = Duration{std::llround(piece.drift_ppm * 1e-6 * since(piece.begin, stamp))};
  }
  return stamp + piece.offset + drifted;
}

std::optional<Duration> half_width(const TimeModel& model, Time stamp) {
  return piece_at(model, stamp).half_width;
}

bool any_known(const TimeModel& model) {
  return std::any_of(model.pieces.begin(), model.pieces.end(),
                     [](const TimeModelPiece& piece) { return piece.half_width.has_value(); });
}

std::int64_t interval_ns(const TimeModel& model, Time stamp) {
  const auto known = half_width(model, stamp);
  return known ? known->count() : no_interval;
}

}  // namespace kinalign
