// SPDX-License-Identifier: Apache-2.0
// kinalign/wire is compiled freestanding, without exceptions and RTTI. This tests which outside
// functions it still calls.
#include "tests/symbols.h"

using namespace kinalign;

TEST_CASE("wire calls nothing but itself and the four functions that any compiler asks for" *
          doctest::description("a sanitizer's calls are in it") * doctest::skip(sanitized)) {
  CHECK(called_from_outside(KINALIGN_WIRE_LIBRARY) == std::set<std::string>{});
}
