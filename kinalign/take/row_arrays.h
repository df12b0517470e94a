// SPDX-License-Identifier: Apache-2.0
// The arrays of a take's rows with their names. Every file format uses these names.
#pragma once

#include "kinalign/take/take.h"

#include <type_traits>

namespace kinalign {

/// Calls use(name, of) for each array of Rows; of(rows) returns the array. Arrays that a stream
/// leaves empty are included. All code that reads, writes or joins takes uses this list, so a new
/// array needs to be added only here. SampleDistance::over_loss is not in the list, since no file
/// stores it.
template <class Rows, class Use>
void for_each_column(Use&& use) {
  if constexpr (std::is_same_v<Rows, ImuRows>) {
    use(
        "orientation", [](auto& rows) -> auto& { return rows.orientation; });
    use(
        "acceleration", [](auto& rows) -> auto& { return rows.acceleration; });
    use(
        "angular_velocity", [](auto& rows) -> auto& { return rows.angular_velocity; });
  } else {
    use(
        "positions", [](auto& rows) -> auto& { return rows.positions; });
  }
  if constexpr (std::is_same_v<Rows, ClipRows>) {
    use(
        "local_positions", [](auto& rows) -> auto& { return rows.local_positions; });
    use(
        "local_rotations", [](auto& rows) -> auto& { return rows.local_rotations; });
  }
  if constexpr (std::is_same_v<Rows, PointRows>) {
    use(
        "state", [](auto& rows) -> auto& { return rows.state; });
  }
  use(
      "valid", [](auto& rows) -> auto& { return rows.valid; });
  use(
      "nearest_raw_ns", [](auto& rows) -> auto& { return rows.distance.nearest_raw_ns; });
  use(
      "time_interval_ns", [](auto& rows) -> auto& { return rows.distance.time_interval_ns; });
}

}  // namespace kinalign
