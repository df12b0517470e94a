// SPDX-License-Identifier: Apache-2.0
// The node's logic is compiled freestanding, without exceptions and RTTI. This tests which outside
// functions it still calls: no heap, no operating system.
#include "tests/symbols.h"

using namespace kinalign;

TEST_CASE("the node calls nothing but wire and the functions that any compiler asks for" *
          doctest::description("a sanitizer's calls are in it") * doctest::skip(sanitized)) {
  auto called = called_from_outside(KINALIGN_NODE_LIBRARY);
  for (const auto& name : symbols(KINALIGN_WIRE_LIBRARY, "--defined-only")) called.erase(name);
  CHECK(called == std::set<std::string>{});
}
