// SPDX-License-Identifier: Apache-2.0
#include "kinalign/resample/segments.h"

#include "tests/seeds.h"

#include "kinalign/resample/resample.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>

using namespace kinalign;

namespace {

using Stamps = std::vector<std::int64_t>;
using Segments = std::vector<std::array<std::size_t, 4>>;

Segments segments(const Stamps& stamps, const Stamps& grid, std::int64_t gap) {
  Segments out;
  for (const Segment& s : find_segments(stamps, grid, gap)) {
    out.push_back({s.first, s.last, s.row, s.row_end});
  }
  return out;
}

Stamps rising(std::size_t most, std::mt19937_64& random) {
  Stamps out;
  std::int64_t t = static_cast<std::int64_t>(random() % 50);
  for (std::uint64_t n = random() % most; n > 0; --n) {
    out.push_back(t);
    t += 1 + static_cast<std::int64_t>(random() % 20);
  }
  return out;
}

}  // namespace

TEST_CASE("knots break where two are farther apart than a gap; rows on a knot belong to it") {
  CHECK(segments({0, 10, 20}, {0, 5, 20}, 10) == Segments{{0, 3, 0, 3}});
  CHECK(segments({0, 10, 21}, {0, 5, 15, 21}, 10) == Segments{{0, 2, 0, 2}, {2, 3, 3, 4}});
  CHECK(segments({10}, {9, 10, 11}, 5) == Segments{{0, 1, 1, 2}});
}

TEST_CASE("segments without rows are left out, and nothing is made of nothing") {
  CHECK(segments({0, 10, 30, 40, 60, 70}, {35}, 10) == Segments{{2, 4, 0, 1}});
  CHECK(segments({}, {1, 2}, 10).empty());
  CHECK(segments({1, 2}, {}, 10).empty());
  CHECK(segments({10, 20}, {1, 2, 25}, 10).empty());
}

TEST_CASE("each row lies in the one segment whose knots enclose it, or in none") {
  for (const std::uint64_t seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Stamps stamps = rising(30, random), grid = rising(60, random);
    const auto gap = static_cast<std::int64_t>(1 + random() % 25);
    std::vector<int> times(grid.size(), 0);
    for (const Segment& s : find_segments(stamps, grid, gap)) {
      REQUIRE(s.first < s.last);
      REQUIRE(s.row < s.row_end);
      for (std::size_t i = s.first + 1; i < s.last; ++i) CHECK(stamps[i] - stamps[i - 1] <= gap);
      for (std::size_t r = s.row; r < s.row_end; ++r) {
        ++times[r];
        CHECK(stamps[s.first] <= grid[r]);
        CHECK(grid[r] <= stamps[s.last - 1]);
      }
    }
    for (std::size_t r = 0; r < grid.size(); ++r) {
      const auto behind = std::lower_bound(stamps.begin(), stamps.end(), grid[r]);
      const bool on = behind != stamps.end() && *behind == grid[r];
      const bool between =
          behind != stamps.begin() && behind != stamps.end() && *behind - *(behind - 1) <= gap;
      CHECK(times[r] == (on || between ? 1 : 0));
    }
  }
}

TEST_CASE("a row's neighbours are the last sample at or before it and the nearest of all") {
  for (const std::uint64_t seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Stamps stamps = rising(30, random), grid = rising(60, random);
    const Neighbours near = find_neighbours(stamps, grid);
    REQUIRE(near.left.size() == grid.size());
    REQUIRE(near.nearest_raw_ns.size() == grid.size());
    for (std::size_t r = 0; r < grid.size(); ++r) {
      const bool outside = stamps.empty() || grid[r] < stamps.front() || grid[r] > stamps.back();
      const auto behind = std::upper_bound(stamps.begin(), stamps.end(), grid[r]);
      const auto left = static_cast<std::size_t>(behind - stamps.begin()) - 1;
      CHECK(near.left[r] == (outside ? stamps.size() : left));
      std::int64_t nearest = farthest_nearest_ns;
      for (const std::int64_t t : stamps) nearest = std::min(nearest, std::abs(t - grid[r]));
      CHECK(near.nearest_raw_ns[r] == nearest);
    }
  }
}

TEST_CASE("seconds from an origin keep the nanosecond at any date") {
  const std::int64_t origin = 1'700'000'000'000'000'000;
  const auto s = seconds_from(origin, Stamps{origin - 1, origin, origin + 1, origin + 500'000'001});
  CHECK(s[0] == -1e-9);
  CHECK(s[1] == 0.0);
  CHECK(s[2] == 1e-9);
  CHECK(s[3] == doctest::Approx(0.500000001).epsilon(1e-15));
}
