// SPDX-License-Identifier: Apache-2.0
// Two takes that must have the same rows and counts, bit by bit.
#pragma once

#include "kinalign/take/take.h"

#include <doctest/doctest.h>

#include <tuple>
#include <variant>

namespace kinalign::test {

inline auto all_of(const SampleDistance& d) {
  return std::tie(d.nearest_raw_ns, d.time_interval_ns);
}
inline auto all_of(const ClipRows& r) {
  return std::tuple_cat(std::tie(r.positions, r.local_positions, r.local_rotations, r.valid),
                        all_of(r.distance));
}
inline auto all_of(const PointRows& r) {
  return std::tuple_cat(std::tie(r.positions, r.state, r.valid), all_of(r.distance));
}
inline auto all_of(const ImuRows& r) {
  return std::tuple_cat(std::tie(r.orientation, r.acceleration, r.angular_velocity, r.valid),
                        all_of(r.distance));
}
inline auto counts_of(const StreamReport& r) {
  return std::tie(r.held_back, r.arrivals, r.gaps, r.gap_time_ns, r.samples, r.invalid,
                  r.empty_rows, r.inferred, r.bridged, r.unsure, r.worst_nearest_ns);
}

inline void check_same(const Take& a, const Take& b) {
  CHECK(a.all.stamps == b.all.stamps);
  REQUIRE(a.all.rows.size() == b.all.rows.size());
  for (std::size_t g = 0; g < a.all.rows.size(); ++g) {
    CAPTURE(a.header.groups[g].name);
    REQUIRE(a.all.rows[g].index() == b.all.rows[g].index());
    std::visit(
        [&](const auto& rows) {
          using Rows = std::decay_t<decltype(rows)>;
          CHECK((all_of(rows) == all_of(std::get<Rows>(b.all.rows[g]))));
        },
        a.all.rows[g]);
  }
  REQUIRE(a.report.streams.size() == b.report.streams.size());
  for (std::size_t i = 0; i < a.report.streams.size(); ++i) {
    CAPTURE(a.report.streams[i].stream);
    CHECK((counts_of(a.report.streams[i]) == counts_of(b.report.streams[i])));
  }
}

}  // namespace kinalign::test
