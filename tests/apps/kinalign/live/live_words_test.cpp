// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/live/live_words.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("a port alone is one of this machine, and a host may stand before it") {
  const auto port = parse_endpoint("7040", "--live");
  REQUIRE(port);
  CHECK(port->host == "127.0.0.1");
  CHECK(port->port == 7040);
  CHECK(parse_endpoint("192.168.7.5:7040", "--live")->host == "192.168.7.5");
  CHECK(parse_endpoint("[::1]:7040", "--live")->host == "::1");
}

TEST_CASE("a wrong port is refused with its flag") {
  for (const char* text : {"", "0", "65536", "-1", "7040x", ":7040", "a:", "7040:"}) {
    CAPTURE(text);
    const auto refused = parse_endpoint(text, "--live");
    REQUIRE(!refused);
    CHECK(refused.error().file == "--live");
  }
}

TEST_CASE("a file goes with no --live, and flags of live runs with nothing else") {
  LiveWords words;
  CHECK(check(words, {"take.h5"}));
  CHECK(!check(words, {}));
  words.look_ahead = 4;
  CHECK(check(words, {"take.h5"}).error().file == "--look-ahead");
  words.live = "7040";
  CHECK(check(words, {}));
  CHECK(check(words, {"take.h5"}).error().file == "--live");
  words.send = "nowhere";
  CHECK(check(words, {}).error().file == "--send");
}
