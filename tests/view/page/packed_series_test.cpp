// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/packed_series.h"

#include <doctest/doctest.h>

#include <vector>

using namespace kinalign;

TEST_CASE("Base64 is that of RFC 4648") {
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foobar") == "Zm9vYmFy");
}
