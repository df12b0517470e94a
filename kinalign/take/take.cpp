// SPDX-License-Identifier: Apache-2.0
#include "kinalign/take/take.h"

#include <type_traits>

namespace kinalign {

void append_rows(TakeSlab& all, const TakeSlab& slab) {
  const auto join = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  join(all.stamps, slab.stamps);
  if (all.rows.empty()) {
    all.rows = slab.rows;
    return;
  }
  for (std::size_t g = 0; g < all.rows.size(); ++g) {
    std::visit(
        [&](auto& to) {
          const auto& from = std::get<std::remove_reference_t<decltype(to)>>(slab.rows[g]);
          join(to.valid, from.valid);
          join(to.distance.nearest_raw_ns, from.distance.nearest_raw_ns);
          join(to.distance.time_interval_ns, from.distance.time_interval_ns);
          if constexpr (requires { to.positions; }) join(to.positions, from.positions);
          if constexpr (requires { to.state; }) join(to.state, from.state);
          if constexpr (requires { to.local_positions; }) {
            join(to.local_positions, from.local_positions);
            join(to.local_rotations, from.local_rotations);
          }
          if constexpr (requires { to.orientation; }) {
            join(to.orientation, from.orientation);
            join(to.acceleration, from.acceleration);
            join(to.angular_velocity, from.angular_velocity);
          }
        },
        all.rows[g]);
  }
}

}  // namespace kinalign
