// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/ntp/chrony_tracking.h"

#include "tests/about.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace kinalign;

namespace {

std::vector<std::uint8_t> bytes_of(const std::string& hex) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

/// chrony 4.3's answer to the request below; `chronyc -c tracking` said at that moment
/// 7F000001,127.0.0.1,4,1795349837.277403190,...,0.000006535,0.000001288,1.0,Normal
const std::vector<std::uint8_t> real = bytes_of(
    "060200000021000500000000000000000102030400000000000000007f0000017f0000010000000000000000000000"
    "00"
    "0001000000040000000000006b02dd4d1088d636dd279884d52ce1d9d8ef04cbfb2d9eb3f105b7d6fe94b814e0db47"
    "39"
    "dca821d80483997a");

}  // namespace

TEST_CASE("the request is the one that chronyd answered") {
  const auto request = chrony_tracking_request(0x01020304);
  std::vector<std::uint8_t> expected = bytes_of("060100000021000001020304");
  expected.resize(104);
  CHECK(std::vector(request.begin(), request.end()) == expected);
}

TEST_CASE("chronyd's answer says what chronyc says") {
  const auto tracking = decode_chrony_tracking(real, 0x01020304);
  REQUIRE(tracking);
  CHECK(tracking->stratum == 4);
  CHECK(tracking->leap == NtpLeap::none);
  CHECK(to_ns(tracking->reference) == 1'795'349'837'277'403'190);
  CHECK(seconds(tracking->root_delay) == about(6.535e-6, 2e-4));
  // dca821d8: 0xa821d8 * 2^(-18 - 25). It differs from chronyc's value because it grows, and
  // chronyc asked at another moment.
  CHECK(seconds(tracking->root_dispersion) == about(std::ldexp(0xa821d8, -43), 1e-3));
}

TEST_CASE("an answer to something else, a refusal or a part of one is none") {
  CHECK(!decode_chrony_tracking(real, 0x01020305));
  for (const std::size_t at : {0U, 1U, 5U, 7U, 9U}) {  // version, kind, command, answer, status
    auto other = real;
    other[at] ^= 1;
    CHECK(!decode_chrony_tracking(other, 0x01020304));
  }
  for (std::size_t size = 0; size < 100; ++size) {
    CHECK(!decode_chrony_tracking(std::span(real).first(size), 0x01020304));
  }
}

TEST_CASE("garbage: any numbers in an answer give values that NTP can represent") {
  for (const auto seed : fresh_seeds(2000)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    auto bytes = real;
    for (std::size_t i = 28; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(random());
    const auto tracking = decode_chrony_tracking(bytes, 0x01020304);
    REQUIRE(tracking);
    for (const Duration d : {tracking->root_delay, tracking->root_dispersion}) {
      CHECK(d >= Duration{0});
      CHECK(d <= std::chrono::seconds(65'536));
    }
    CHECK(tracking->reference >= Time{});
  }
}
