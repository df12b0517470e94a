// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/clockless.h"

#include "tests/wire/node_cases.h"

#include "kinalign/wire/node_layout.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

template <class Datagram>
std::string fate_of_byte(std::size_t at, std::uint8_t value) {
  Bytes bytes = encoded(Datagram{}, nullptr);
  bytes[at] = value;
  REQUIRE(!seal(bytes, nullptr).empty());
  return fate<Datagram>(bytes, nullptr);
}

}  // namespace

TEST_CASE("an answer is never longer than the smallest request with the same key") {
  CHECK(encoded(ClocklessRequest{}, nullptr).size() == 48);
  CHECK(encoded(ClocklessRequest{}, &counted_key).size() == 56);
  CHECK(encoded(ClocklessAnswer{}, nullptr).size() == 48);
  CHECK(encoded(ClocklessAnswer{}, &counted_key).size() == 56);
  CHECK(encoded(ClocklessConfirm{}, nullptr).size() == 48);
  CHECK(encoded(ClocklessConfirm{}, &counted_key).size() == 56);
}

TEST_CASE("a request has one sample at the most, and nothing in the room for its answer") {
  CHECK(fate_of_byte<ClocklessRequest>(21, 2) == "too_many_samples");
  CHECK(fate_of_byte<ClocklessRequest>(21, 1) == "wrong_fields");
  CHECK(fate_of_byte<ClocklessRequest>(24, 1) == "stray_bits");
  CHECK(fate_of_byte<ClocklessRequest>(43, 1) == "stray_bits");
  CHECK(fate_of_byte<ClocklessRequest>(20, 4) == "stray_bits");  // an echo
}

TEST_CASE("an answer and a confirm have no flags but the MAC's, and are not each other") {
  for (const std::size_t at : {20, 21, 22, 23}) {
    CAPTURE(at);
    CHECK(fate_of_byte<ClocklessAnswer>(at, 2) == "stray_bits");
    CHECK(fate_of_byte<ClocklessConfirm>(at, 2) == "stray_bits");
  }
  CHECK(fate_of_byte<ClocklessAnswer>(5, 5) == "wrong_type");
  CHECK(fate_of_byte<ClocklessConfirm>(5, 4) == "wrong_type");
}
