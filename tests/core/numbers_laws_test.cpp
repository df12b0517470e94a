// SPDX-License-Identifier: Apache-2.0
// Rules for any number as text, and for any bytes' digest.
#include "tests/seeds.h"
#include "tests/witness.h"

#include "kinalign/core/hash.h"
#include "kinalign/core/numbers.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <string>

using namespace kinalign;

namespace {

std::string written(double value, int decimals) {
  std::string text(number_room, '?');
  text.resize(static_cast<std::size_t>(put_number(text.data(), value, decimals) - text.data()));
  return text;
}

double number(const std::string& text) {
  double value = 0.0;
  REQUIRE(parse_number(text, value));
  return value;
}

/// The number of significant digits: 2 for "-0.0120e5", 1 for "1000".
std::size_t digits_of(const std::string& text) {
  std::string digits;
  for (const char c : text.substr(0, text.find('e'))) {
    if (c >= '0' && c <= '9' && (c != '0' || !digits.empty())) digits += c;
  }
  while (digits.ends_with('0')) digits.pop_back();
  return std::max<std::size_t>(digits.size(), 1);
}

/// Random finite doubles, some with few decimals.
Arrays random_numbers(std::mt19937_64& random) {
  std::vector<double> values;
  while (values.size() < 5000) {
    const auto whole = static_cast<double>(static_cast<std::int64_t>(random()) >> (random() % 60));
    const double any = random() % 2 == 0 ? std::bit_cast<double>(random()) : whole / 1e6;
    if (std::isfinite(any)) values.push_back(any);
  }
  return {{"values", values}};
}

}  // namespace

TEST_CASE("a number is written with no more digits than Python needs, and reads back") {
  for (const auto seed : fresh_seeds(2)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Arrays given = random_numbers(random);
    const auto digits = run_python("shortest_digits.py", given).at("digits");
    const auto& values = given.at("values");
    REQUIRE(digits.size() == values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::string text = written(values[i], static_cast<int>(random() % 16));
      CAPTURE(text);
      const auto needed = static_cast<std::size_t>(digits[i]);
      // A large whole number is written with all digits if that is no longer than 1.2345e+20.
      const bool whole = text.find_first_of(".e") == std::string::npos;
      CHECK((digits_of(text) == needed || (whole && text.size() <= needed + 6)));
      CHECK(std::bit_cast<std::uint64_t>(number(text)) == std::bit_cast<std::uint64_t>(values[i]));
    }
  }
}

TEST_CASE("any text of up to fifteen digits is written again as it stood, with its decimals") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (int i = 0; i < 2000; ++i) {
      const auto decimals = random() % 15, whole = random() % (16 - decimals);
      std::string text = random() % 2 == 0 ? "-" : "";
      text += whole == 0 ? '0' : static_cast<char>('1' + random() % 9);
      for (std::size_t k = 1; k < whole; ++k) text += static_cast<char>('0' + random() % 10);
      for (std::size_t k = 0; k < decimals; ++k) {
        text += (k == 0 ? "." : "") + std::to_string(random() % 10);
      }
      CHECK(decimals_of(text) == static_cast<int>(decimals));
      CHECK(written(number(text), decimals_of(text)) == text);
    }
  }
}

TEST_CASE("a number stays itself with zeros around it, and turns with its sign") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (int i = 0; i < 2000; ++i) {
      const std::string digits = std::to_string(random() >> (random() % 60));
      const std::size_t point = random() % (digits.size() + 1);
      const std::string text = digits.substr(0, point) + "." + digits.substr(point);
      const double value = number(text);
      CHECK(number("00" + text + std::string(random() % 20, '0')) == value);
      CHECK(number("+" + text) == value);
      CHECK(number("-" + text) == -value);
      // Moving the point is the same as an exponent.
      CHECK(number(digits + "e-" + std::to_string(digits.size() - point)) == value);
    }
  }
}

TEST_CASE("SHA-256 of any bytes, in any pieces, is Python's") {
  for (const auto seed : fresh_seeds(1)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const FreshFolder folder;
    std::map<std::string, std::string> ours;
    for (int file = 0; file < 200; ++file) {
      std::string bytes(file < 150 ? static_cast<std::size_t>(file) : random() % 5000, '\0');
      for (char& c : bytes) c = static_cast<char>(random());
      folder.write(std::to_string(file), bytes);
      Sha256 hash;
      for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t n = std::min<std::size_t>(random() % 150, bytes.size() - at);
        hash.update(std::string_view(bytes).substr(at, n));
        at += n;
      }
      ours[std::to_string(file)] = hash.hex();
    }
    REQUIRE(run_witness("sha256.py", folder.path()) == 0);
    for (const auto& [name, digest] : ours) CHECK(folder.read(name + ".sha256") == digest);
  }
}
