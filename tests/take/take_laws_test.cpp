// SPDX-License-Identifier: Apache-2.0
// Rules for the rows of any take, and a check that none of their arrays is forgotten.
#include "tests/formats/take/take_samples.h"
#include "tests/seeds.h"

#include "kinalign/take/row_arrays.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <set>
#include <string>
#include <vector>

using namespace kinalign;

namespace {

/// Calls use(name, array) for each array of a slab's groups, beside the stamps.
template <class Slab, class Use>
void for_each_array(Slab& slab, Use&& use) {
  for (std::size_t g = 0; g < slab.rows.size(); ++g) {
    std::visit(
        [&](auto& rows) {
          for_each_column<std::remove_cvref_t<decltype(rows)>>(
              [&](const char* name, auto of) { use(std::to_string(g) + "/" + name, of(rows)); });
        },
        slab.rows[g]);
  }
}

/// Rows from..to of a slab of `all` rows.
TakeSlab part(TakeSlab slab, std::size_t from, std::size_t to) {
  const std::size_t all = slab.stamps.size();
  const auto cut = [&](auto& array) {
    const std::size_t width = all == 0 ? 0 : array.size() / all;
    array.erase(array.begin() + static_cast<std::ptrdiff_t>(to * width), array.end());
    array.erase(array.begin(), array.begin() + static_cast<std::ptrdiff_t>(from * width));
  };
  for_each_array(slab, [&](const std::string&, auto& array) { cut(array); });
  cut(slab.stamps);
  slab.first += from;
  return slab;
}

void check_same(const TakeSlab& a, const TakeSlab& b) {
  CHECK(a.first == b.first);
  CHECK(a.stamps == b.stamps);
  REQUIRE(a.rows.size() == b.rows.size());
  for (std::size_t g = 0; g < a.rows.size(); ++g) {
    std::visit(
        [&](const auto& rows) {
          using Rows = std::remove_cvref_t<decltype(rows)>;
          REQUIRE(std::holds_alternative<Rows>(b.rows[g]));
          const auto& other = std::get<Rows>(b.rows[g]);
          for_each_column<Rows>([&](const char* name, auto of) {
            CAPTURE(g);
            CAPTURE(name);
            CHECK(of(rows) == of(other));
          });
        },
        a.rows[g]);
  }
}

template <class Rows>
std::vector<std::string> columns() {
  std::vector<std::string> names;
  std::set<const void*> arrays;
  const Rows rows{};
  for_each_column<Rows>([&](const char* name, auto of) {
    names.emplace_back(name);
    CHECK(arrays.insert(&of(rows)).second);
  });
  return names;
}

}  // namespace

TEST_CASE("a take cut into slabs anywhere and put together again is the take") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::size_t frames = random() % 40;
    const TakeSlab whole = sample_take(frames, seed).all;
    TakeSlab all;
    for (std::size_t at = 0; at < frames || all.rows.empty();) {
      const std::size_t to = std::min<std::size_t>(at + random() % 9, frames);
      append_rows(all, part(whole, at, to));
      at = to;
    }
    check_same(all, whole);
    append_rows(all, part(whole, frames, frames));  // no rows, so nothing changes
    check_same(all, whole);
  }
}

TEST_CASE("it is no matter which of three slabs are put together first") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::size_t frames = 3 + random() % 20, a = random() % frames;
    const std::size_t b = a + random() % (frames - a);
    const TakeSlab whole = sample_take(frames, seed).all;
    TakeSlab left = part(whole, 0, a), right = part(whole, a, b);
    append_rows(left, part(whole, a, b));
    append_rows(left, part(whole, b, frames));
    append_rows(right, part(whole, b, frames));
    TakeSlab other = part(whole, 0, a);
    append_rows(other, right);
    check_same(left, other);
  }
}

TEST_CASE("every array that a take stores has the name of its documentation, once") {
  using Names = std::vector<std::string>;
  CHECK(columns<ClipRows>() == Names{"positions", "local_positions", "local_rotations", "valid",
                                     "nearest_raw_ns", "time_interval_ns"});
  CHECK(columns<PointRows>() ==
        Names{"positions", "state", "valid", "nearest_raw_ns", "time_interval_ns"});
  CHECK(columns<ImuRows>() == Names{"orientation", "acceleration", "angular_velocity", "valid",
                                    "nearest_raw_ns", "time_interval_ns"});
  // If a member is added or removed, these names no longer fit and this does not compile: then
  // for_each_column must be changed, too.
  const auto& [places, locals, turns, clip_valid, clip_distance] = ClipRows{};
  const auto& [points, state, point_valid, point_distance] = PointRows{};
  const auto& [orientation, acceleration, rate, imu_valid, imu_distance] = ImuRows{};
  const auto& [nearest, interval, over_loss] = SampleDistance{};
}
