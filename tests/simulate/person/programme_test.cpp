// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/person/programme.h"

#include "tests/about.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <set>

using namespace kinalign;

TEST_CASE("the default programme begins in T-pose, holds all but slow pieces, as long as asked") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    const Programme programme = default_programme(300.0, seed);
    CHECK(programme.front().piece == Piece::t_pose);
    const double length = std::accumulate(
        programme.begin(), programme.end(), 0.0,
        [](double sum, const ProgrammePiece& piece) { return sum + piece.length_s; });
    CHECK(length == about(300.0));
    std::set<Piece> all;
    for (std::size_t i = 0; i < 9; ++i) all.insert(programme[i].piece);
    CHECK(all.size() == 9);
    CHECK(std::none_of(programme.begin(), programme.end(),
                       [](const ProgrammePiece& one) { return is_slow(one.piece); }));
  }
  CHECK(default_programme(2.0, 1).size() == 1);
  CHECK(default_programme(0.0, 1).empty());
}

TEST_CASE("the order and the lengths differ from round to round and from seed to seed") {
  const auto pieces = [](const Programme& programme, std::size_t from) {
    std::vector<Piece> found;
    for (std::size_t i = from; i < from + 8; ++i) found.push_back(programme[i].piece);
    return found;
  };
  const Programme one = default_programme(300.0, 1), two = default_programme(300.0, 2);
  CHECK(pieces(one, 1) != pieces(one, 9));
  CHECK(pieces(one, 1) != pieces(two, 1));
}

TEST_CASE("acts follow each other, each drawn again within its ranges") {
  const auto acts = acts_of({{Piece::wave, 4.0}, {Piece::walk, 0.0}, {Piece::wave, 5.0}}, 3);
  REQUIRE(acts.size() == 2);
  CHECK(acts[0].first);
  CHECK_FALSE(acts[0].last);
  CHECK(acts[1].last);
  CHECK(acts[1].begin_s == 4.0);
  CHECK(acts[1].end_s == 9.0);
  CHECK(acts[0].tempo_s != acts[1].tempo_s);
  for (const Act& act : acts) {
    CHECK(act.amplitude >= 0.85);
    CHECK(act.amplitude <= 1.15);
    CHECK(act.tempo_s >= 0.65);
    CHECK(act.tempo_s <= 0.95);
    CHECK(std::abs(act.side) == 1.0);
  }
  CHECK(&act_at(acts, -1.0) == &acts[0]);
  CHECK(&act_at(acts, 3.99) == &acts[0]);
  CHECK(&act_at(acts, 4.0) == &acts[1]);
  CHECK(&act_at(acts, 99.0) == &acts[1]);
  CHECK(acts_of({}, 1).size() == 1);
}

TEST_CASE("an act comes in and goes out, but for the first and the last") {
  const auto acts = acts_of({{Piece::wave, 4.0}, {Piece::wave, 4.0}}, 3);
  CHECK(acts[0].within(0.0, 1.0) == 1.0);
  CHECK(acts[0].within(3.5, 1.0) == about(0.5));
  CHECK(acts[0].within(4.0, 1.0) == 0.0);
  CHECK(acts[1].within(4.5, 1.0) == about(0.5));
  CHECK(acts[1].within(8.0, 1.0) == 1.0);
}

TEST_CASE("a slow act is filled with repetitions, another one is not") {
  const auto acts = acts_of({{Piece::twist, 40.0}, {Piece::squat, 9.0}}, 3);
  REQUIRE(acts.size() == 2);
  CHECK(acts[0].repetitions.size() >= 4);
  CHECK(acts[0].repetitions.front().begin_s == 0.0);
  CHECK(acts[0].repetitions.back().end_s == about(40.0));
  CHECK(acts[1].repetitions.empty());
}
