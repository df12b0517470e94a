// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/held_back.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

Moment at(int ms) {
  return {HostTime{std::chrono::milliseconds(ms)}, Time{std::chrono::milliseconds(1000 + ms)}};
}

std::vector<int> released(HeldBack<int>& held, const std::optional<Moment>& until) {
  std::vector<int> out;
  held.release(until, [&](int item) { out.push_back(item); });
  return out;
}

}  // namespace

TEST_CASE("what came behind a moment is held, and released up to another") {
  HeldBack<int> held;
  CHECK_FALSE(held.must_hold(at(10), 1, at(10)));
  CHECK(held.must_hold(at(11), 1, at(10)));
  CHECK_FALSE(held.must_hold(at(11), 1, std::nullopt));
  for (const int ms : {11, 12, 13}) held.hold(at(ms), 1, ms);
  CHECK(released(held, at(12)) == std::vector{11, 12});
  CHECK(held.size() == 1);
  CHECK(released(held, std::nullopt) == std::vector{13});
  CHECK(held.size() == 0);
}

TEST_CASE("one sender's messages stay in order, and wait for no other sender's") {
  HeldBack<int> held;
  held.hold(at(20), 1, 1);
  CHECK(held.must_hold(at(9), 1, at(10)));
  // Sender 2 has another socket, which is read later.
  CHECK_FALSE(held.must_hold(at(9), 2, at(10)));
  held.hold(at(9), 1, 2);
  held.hold(at(8), 2, 3);
  CHECK(released(held, at(10)) == std::vector{3});
  CHECK(released(held, at(20)) == std::vector{1, 2});
}
