// SPDX-License-Identifier: Apache-2.0
// The arrays of a take's rows with their names, which are the same in every file format.
#pragma once

#include "kinalign/take/take.h"

#include <type_traits>

namespace kinalign {

/// Calls use(name, of) for each array of Rows; of(rows) gives the array. Arrays that a stream
/// leaves empty are included. Readers, writers and joins of takes all go through this list, so an
/// array that is added here is in all of them. SampleDistance::over_loss is absent, since no file
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
