// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/nearest_name.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("the nearest name counts letters put in, left out, changed and swapped") {
  const std::vector<std::string> verbs{"align", "info", "check", "convert"};
  CHECK(nearest_name("algin", verbs) == "align");
  CHECK(nearest_name("convrt", verbs) == "convert");
  CHECK(nearest_name("chack", verbs) == "check");
  CHECK(nearest_name("inof", verbs) == "info");
}

TEST_CASE("the beginning of a name leads to it, if it has three letters") {
  CHECK(nearest_name("conv", {"config", "convert"}) == "convert");
  CHECK(nearest_name("sub", {"action", "subject"}) == "subject");
  CHECK(nearest_name("su", {"action", "subject"}).empty());
}

TEST_CASE("a name that is like none has no nearest one") {
  CHECK(nearest_name("time-server", {"align", "info"}).empty());
  CHECK(nearest_name("align", {}).empty());
}

TEST_CASE("only the beginning of a long name is compared") {
  CHECK(nearest_name(std::string(1 << 20, 'a'), {std::string(64, 'a')}) == std::string(64, 'a'));
}

TEST_CASE("a name that is not known leads to the nearest one, by letters to change") {
  const auto nearest = [](const char* name) {
    return to_string(unknown_name(name, "a verb", {"align", "check", "convert"}));
  };
  CHECK(nearest("algin") == "expected a verb (nearest: align), found \"algin\"");
  CHECK(nearest("chekc") == "expected a verb (nearest: check), found \"chekc\"");
  CHECK(nearest("conv") == "expected a verb (nearest: convert), found \"conv\"");
  CHECK(to_string(unknown_name("x", "a stream", {})) == "expected a stream, found \"x\"");
}
