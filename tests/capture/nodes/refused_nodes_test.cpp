// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/nodes/refused_nodes.h"

#include <doctest/doctest.h>

namespace kinalign {

namespace {

HostTime at(double s) { return HostTime{Duration{static_cast<std::int64_t>(s * 1e9)}}; }

}  // namespace

TEST_CASE("each refused node is reported within a second of the previous one, and seldom again") {
  RefusedNodes refused;
  int told = 0;
  for (int k = 0; k < 6000; ++k) {
    const auto id = static_cast<std::uint32_t>(11 + k % 3);
    if (refused.take(NodeRefusal::wrong_mac, id, at(0.1 * k))) {
      CHECK(k <= 30);
      ++told;
    }
  }
  CHECK(told == 3);
  CHECK(refused.take(NodeRefusal::wrong_mac, 11, at(600)));
  CHECK_FALSE(refused.take(NodeRefusal::wrong_mac, 12, at(600.9)));
  CHECK(refused.take(NodeRefusal::no_mac, 12, at(601)));  // another mistake
  CHECK(refused.claims().size() == 4);
  CHECK_FALSE(refused.others(NodeRefusal::wrong_mac));
}

TEST_CASE("strangers do not make the table grow, nor the first ids leave it") {
  RefusedNodes refused;
  refused.take(NodeRefusal::wrong_mac, 7, at(0));
  int told = 0;
  for (std::uint32_t k = 0; k < 100'000; ++k) {
    told += refused.take(NodeRefusal::no_mac, 1000 + k, at(1 + 0.01 * k)) ? 1 : 0;
  }
  CHECK(refused.claims().size() == RefusedNodes::most);
  CHECK(refused.claims().front().node_id == 7);
  CHECK(refused.others(NodeRefusal::no_mac));
  CHECK_FALSE(refused.others(NodeRefusal::wrong_mac));
  CHECK(told <= 4);  // one node is new and has room, and of the rest one is reported in ten minutes
}

}  // namespace kinalign
