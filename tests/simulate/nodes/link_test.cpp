// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/nodes/link.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

using namespace kinalign;

namespace {

std::vector<double> each_fifteenth(std::size_t n) {
  std::vector<double> sent(n);
  for (std::size_t k = 0; k < n; ++k) sent[k] = static_cast<double>(k) / 15.0;
  return sent;
}

struct Reference {
  Link link;
  Way way;
  std::array<double, 5> delays_ms;
};

// Printed by the reference simulator in Python (clock_sim.py --golden): seed 1, packets at k / 15
// s.
constexpr std::array references{
    Reference{Link::wired, Way::up, {0.078138, 0.065412, 0.064665, 0.073244, 0.08177}},
    Reference{Link::wired, Way::down, {0.118609, 0.060589, 0.080573, 0.062599, 0.056932}},
    Reference{Link::quiet, Way::up, {1.313375, 1.482972, 1.379352, 1.231807, 1.373916}},
    Reference{Link::quiet, Way::down, {1.965744, 0.998743, 1.331796, 1.032239, 0.937787}},
    Reference{Link::paper, Way::up, {5.442932, 52.580181, 54.75919, 50.825078, 13.276864}},
    Reference{Link::paper, Way::down, {34.659673, 3.929166, 50.588128, 22.996289, 3.465899}},
    Reference{Link::modem_sleep, Way::up, {2.060278, 2.208624, 2.046967, 1.897143, 2.18136}},
    Reference{
        Link::modem_sleep, Way::down, {63.172326, 96.971553, 30.970992, 66.105106, 101.64943}},
    Reference{Link::congested, Way::up, {6.077896, 2.572546, 2.435792, 2.746554, 8.238804}},
    Reference{Link::congested, Way::down, {7.053605, 8.082797, 3.242691, 8.358078, 2.181144}},
    Reference{Link::roaming, Way::up, {1.313375, 1.482972, 1.379352, 1.231807, 1.373916}},
    Reference{Link::roaming, Way::down, {1.965744, 0.998743, 1.331796, 1.032239, 0.937787}},
    Reference{Link::thin_floor, Way::up, {37.576294, 11.357255, 10.11718, 18.898973, 50.088362}},
    Reference{Link::thin_floor, Way::down, {72.641584, 24.587465, 31.419329, 26.92569, 8.630828}}};

}  // namespace

TEST_CASE("the delays of each link are those of the reference") {
  const auto sent = each_fifteenth(5);
  for (const Reference& reference : references) {
    CAPTURE(letter(reference.link));
    const auto found = transits({.link = reference.link}, 1, reference.way, sent);
    for (std::size_t k = 0; k < 5; ++k) {
      CHECK(std::abs(found[k].delay * 1e3 - reference.delays_ms[k]) < 6e-7);
      CHECK(!found[k].lost);
    }
  }
}

TEST_CASE("no packet is faster than its floor, and what is not reordered keeps its order") {
  const auto sent = each_fifteenth(2000);
  for (const auto seed : fresh_seeds(5)) {
    CAPTURE(seed);
    for (int i = 0; i < links; ++i) {
      const auto link = static_cast<Link>(i);
      const Floors least = floors(link, seed);
      for (const Way way : {Way::up, Way::down}) {
        const double floor = way == Way::down ? least.down : least.up;
        const auto arrivals = transmit({.link = link}, seed, way, sent);
        std::size_t back = 0;
        double last = 0.0;
        for (std::size_t k = 0; k < sent.size(); ++k) {
          if (!arrivals[k].first) continue;
          CHECK(*arrivals[k].first - sent[k] >= floor);
          back += *arrivals[k].first < last ? 1 : 0;
          last = std::max(last, *arrivals[k].first);
        }
        CHECK(back <= 40);  // 1 % are reordered at most
      }
    }
  }
}

TEST_CASE("packets are lost as often as the link states") {
  const auto sent = each_fifteenth(20000);
  for (const auto seed : fresh_seeds(3)) {
    CAPTURE(seed);
    const auto arrivals = transmit({.link = Link::paper}, seed, Way::up, sent);
    const auto lost =
        std::count_if(arrivals.begin(), arrivals.end(), [](const Arrival& a) { return !a.first; });
    CHECK(std::abs(static_cast<double>(lost) - 400.0) < 6.0 * 20.0);
  }
}

TEST_CASE("a fault loses or delays what is sent while it lasts, one way alone if it says so") {
  const auto sent = each_fifteenth(600);
  LinkOptions options{.link = Link::wired};
  options.faults = {{.begin = 10.0, .end = 20.0, .lost_up = 1.0},
                    {.begin = 30.0, .end = 40.0, .extra_down = 5e-3}};
  const auto up = transmit(options, 4, Way::up, sent), down = transmit(options, 4, Way::down, sent);
  for (std::size_t k = 0; k < sent.size(); ++k) {
    if (sent[k] >= 10.0 && sent[k] < 20.0) CHECK(!up[k].first);
    if (down[k].first && sent[k] >= 30.0 && sent[k] < 40.0) {
      CHECK(*down[k].first - sent[k] >= 5e-3);
    }
  }
}
