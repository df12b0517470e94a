// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/numbers.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

using namespace kinalign;

namespace {

std::string digits(std::size_t n, std::mt19937_64& random) {
  std::string text;
  for (std::size_t i = 0; i < n; ++i) text += static_cast<char>('0' + random() % 10);
  return text;
}

/// A number as it stands in files: a sign or none, digits, a point or none, sometimes an
/// exponent.
std::string random_decimal(std::mt19937_64& random) {
  std::string text = random() % 3 == 0 ? "-" : "";
  const std::size_t most = random() % 16 == 0 ? 40 : 17;
  const std::size_t all = 1 + random() % most, whole = random() % (all + 1);
  text += digits(whole, random);
  if (whole < all || random() % 8 == 0) text += "." + digits(all - whole, random);
  if (random() % 8 == 0) {
    text += random() % 2 == 0 ? "e" : "E";
    if (random() % 2 == 0) text += random() % 2 == 0 ? "-" : "+";
    text += std::to_string(random() % (random() % 4 == 0 ? 330 : 30));
  }
  return text;
}

/// Whether number() gives the same bits as std::from_chars, and nothing where that finds no
/// number or one out of range.
bool same_as_from_chars(const std::string& text) {
  double expected = 0.0, found = 0.0;
  const char *begin = text.data(), *end = begin + text.size();
  const auto [behind, fault] = std::from_chars(begin, end, expected);
  const char* ours = parse_number(begin, end, found);
  if (fault == std::errc::invalid_argument) return ours == nullptr;
  if (fault == std::errc::result_out_of_range) {
    return ours == nullptr || (ours == behind && found == 0.0);
  }
  return ours == behind &&
         std::bit_cast<std::uint64_t>(expected) == std::bit_cast<std::uint64_t>(found);
}

double number(const std::string& text) {
  double value = 0.0;
  REQUIRE(parse_number(text, value));
  return value;
}

bool refused(const std::string& text) {
  double value = 0.0;
  return !parse_number(text, value);
}

std::string written(double value, int decimals) {
  std::string text(number_room, '?');
  text.resize(static_cast<std::size_t>(put_number(text.data(), value, decimals) - text.data()));
  return text;
}

}  // namespace

TEST_CASE("numbers as files write them are read") {
  CHECK(number(".5") == 0.5);
  CHECK(number("5.") == 5.0);
  CHECK(number("+1") == 1.0);
  CHECK(number("1e5") == 1e5);
  CHECK(number("-12.3456E-2") == -0.123456);
  CHECK(number("0.1") == 0.1);
  CHECK(number("123456789012345") == 123456789012345.0);
  CHECK(number("0.1234567890123456") == 0.1234567890123456);
  CHECK(number("9007199254740993") == 9007199254740992.0);
  CHECK(number("2.2250738585072011e-308") == 2.2250738585072011e-308);
  CHECK(std::signbit(number("-0.000000")));
  CHECK(number("-0.000000") == 0.0);
}

TEST_CASE("what is too small for a double is nothing, what is too large is refused") {
  const std::string zeros(395, '0');
  CHECK(number("1e-400") == 0.0);
  CHECK(std::signbit(number("-1e-400")));
  CHECK(number("0." + zeros + "1") == 0.0);
  CHECK(number("123456e-999999999999") == 0.0);
  CHECK(number("0e999") == 0.0);
  CHECK(refused("1e400"));
  CHECK(refused("1" + zeros));
  CHECK(refused("1" + zeros + "e-5"));
  CHECK(refused("-1e400"));
  CHECK(refused("1e999999999999999999999"));
  CHECK(number("0." + zeros.substr(100) + "1e300") == doctest::Approx(1e4).epsilon(1e-14));
}

TEST_CASE("what is no number is refused") {
  for (const char* text : {"",     "-",   "+",    ".",    "-.",       "+-1", "-+1", "++1", "nan",
                           "-nan", "inf", "-inf", "+inf", "infinity", "e5",  ".e5", "1e",  "1e+",
                           "1,5",  "1 ",  " 1",   "0x10", "1.2.3",    "--1", "1-"}) {
    CAPTURE(text);
    CHECK(refused(text));
  }
  CHECK(refused(std::string(401, '1')));
}

TEST_CASE("any decimal text is read bit for bit as from_chars reads it") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::size_t wrong = 0;
    std::string example;
    for (int i = 0; i < 60000; ++i) {
      const std::string text = random_decimal(random);
      if (same_as_from_chars(text)) continue;
      ++wrong;
      example = text;
    }
    CAPTURE(example);
    CHECK(wrong == 0);
  }
}

TEST_CASE("decimals are counted behind the point") {
  CHECK(decimals_of("12.3400") == 4);
  CHECK(decimals_of("12.") == 0);
  CHECK(decimals_of("12") == 0);
  CHECK(decimals_of("-.5") == 1);
  CHECK(decimals_of("1.5e3") == 0);
}

TEST_CASE("a number with few decimals is written with those of its file") {
  CHECK(written(12.34, 4) == "12.3400");
  CHECK(written(-0.5, 6) == "-0.500000");
  CHECK(written(0.0, 3) == "0.000");
  CHECK(written(-0.0, 3) == "-0.000");
  CHECK(written(7.0, 0) == "7");
  CHECK(written(0.001, 3) == "0.001");
  CHECK(written(99999.99995, 5) == "99999.99995");
  CHECK(written(123456.5, 1) == "123456.5");
}

TEST_CASE("a number that needs more digits than its file's has them") {
  CHECK(written(0.1 + 0.2, 4) == "0.30000000000000004");
  CHECK(written(1e300, 4) == "1e+300");
  CHECK(written(-1e-300, 4) == "-1e-300");
  CHECK(written(4e15, 0) == "4e+15");
  CHECK(written(0.12345, 4) == "0.12345");
}

TEST_CASE("whatever is written reads back as the same double") {
  for (const auto seed : fresh_seeds(10)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::size_t wrong = 0;
    for (int i = 0; i < 20000; ++i) {
      double value = std::bit_cast<double>(random());
      if (i % 2 == 0) {
        value = std::nearbyint(std::uniform_real_distribution<double>(-1e7, 1e7)(random)) / 1e4;
      }
      if (!std::isfinite(value)) continue;
      const std::string text = written(value, static_cast<int>(random() % 16));
      double back = 0.0;
      if (text.size() > number_room || !parse_number(text, back) ||
          std::bit_cast<std::uint64_t>(back) != std::bit_cast<std::uint64_t>(value)) {
        ++wrong;
      }
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("a text with a file's decimals is written again as it stood") {
  for (const auto seed : fresh_seeds(10)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (int decimals = 0; decimals <= 6; ++decimals) {
      for (int i = 0; i < 500; ++i) {
        std::string text = random() % 2 == 0 ? "-" : "";
        text += std::to_string(random() % 1000);
        if (decimals > 0) text += "." + digits(static_cast<std::size_t>(decimals), random);
        CHECK(written(number(text), decimals) == text);
      }
    }
  }
}
