// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/windows/window_places.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

/// `count` stamps, 10 ms apart, from `begin_ms` on.
void add_stamps(std::vector<Time>& stamps, std::int64_t begin_ms, int count) {
  for (int i = 0; i < count; ++i)
    stamps.push_back(Time(std::chrono::milliseconds(begin_ms + 10 * i)));
}

std::vector<Time> stamps_of(int count) {
  std::vector<Time> stamps;
  add_stamps(stamps, 0, count);
  return stamps;
}

std::vector<std::uint64_t> firsts(const WindowPlaces& found) {
  std::vector<std::uint64_t> out;
  for (const WindowPlace& place : found.places) out.push_back(place.first);
  return out;
}

}  // namespace

TEST_CASE("windows: one each step, the last one ends with the take") {
  const auto found = place_windows(stamps_of(25), {10, 5, 0.0});
  CHECK(firsts(found) == std::vector<std::uint64_t>{0, 5, 10, 15});
  CHECK(firsts(place_windows(stamps_of(23), {10, 5, 0.0})) ==
        std::vector<std::uint64_t>{0, 5, 10, 13});
  CHECK(found.rows_left_out == 0);
  for (const WindowPlace& place : found.places) CHECK(place.rows == 10);
}

TEST_CASE("windows: none crosses a gap, and each row of a stretch lies in one") {
  std::vector<Time> stamps;
  add_stamps(stamps, 0, 12);
  add_stamps(stamps, 1000, 15);
  const auto found = place_windows(stamps, {10, 10, 0.0});
  CHECK(firsts(found) == std::vector<std::uint64_t>{0, 2, 12, 17});
}

TEST_CASE("windows: a short take gives a short window, half a window at least") {
  const auto found = place_windows(stamps_of(5), {10, 5, 0.0});
  REQUIRE(found.places.size() == 1);
  CHECK(found.places[0].rows == 5);
  const auto none = place_windows(stamps_of(4), {10, 5, 0.0});
  CHECK(none.places.empty());
  CHECK(none.rows_left_out == 4);
  CHECK(place_windows({}, {10, 5, 0.0}).places.empty());
}

TEST_CASE("windows: at another rate the grid begins at the take's first row") {
  // 100 Hz for 1 s; 40 Hz has 40 rows of 25 ms in 0.99 s.
  const auto found = place_windows(stamps_of(100), {20, 20, 40.0});
  REQUIRE(found.places.size() == 2);
  CHECK(found.places[0].first == 0);
  CHECK(found.places[1].begin == Time(std::chrono::milliseconds(500)));
  CHECK(found.places[1].first == 50);
  // Its last row, at 975 ms, lies between rows 97 and 98.
  CHECK(found.places[1].take_rows == 98 - 50 + 1);
}

TEST_CASE("windows: steps longer than windows leave rows out, but not the last ones") {
  CHECK(firsts(place_windows(stamps_of(35), {10, 20, 0.0})) ==
        std::vector<std::uint64_t>{0, 20, 25});
}
