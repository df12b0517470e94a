// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/packed_series.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace kinalign;

namespace {

std::string bytes_of_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  std::uint32_t held = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    held = held << 6 | static_cast<std::uint32_t>(digits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    out += static_cast<char>(held >> bits & 255);
  }
  return out;
}

/// A reader of the format by the header's description, bit by bit. It checks the writer here, and
/// assets/data.js in tests/apps/report_check.py.
class PlainReader {
 public:
  explicit PlainReader(std::string bytes) : bytes_(std::move(bytes)) {}
  std::uint32_t bits(unsigned count) {
    std::uint32_t out = 0;
    for (unsigned i = 0; i < count; ++i, ++at_) {
      const auto byte = static_cast<unsigned char>(bytes_.at(at_ / 8));
      out = out << 1 | (byte >> (7 - at_ % 8) & 1u);
    }
    return out;
  }
  std::int64_t number(unsigned k) {
    unsigned zeros = 0;
    while (zeros < 20 && bits(1) == 0) ++zeros;
    const std::uint32_t u = zeros == 20 ? bits(32) : zeros << k | bits(k);
    return (u & 1u) != 0 ? -static_cast<std::int64_t>(u / 2) - 1 : static_cast<std::int64_t>(u / 2);
  }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

std::vector<std::int64_t> unpacked(const std::string& text, std::size_t rows, std::size_t columns) {
  PlainReader reader(bytes_of_base64(text));
  std::vector<std::int64_t> out(rows * columns);
  for (std::size_t c = 0; c < columns; ++c) {
    std::int64_t last = 0, before = 0;
    unsigned order = 0, k = 0;
    for (std::size_t r = 0; r < rows; ++r) {
      if (r % 256 == 0) {
        order = reader.bits(2);
        k = reader.bits(5);
      }
      std::int64_t x = k == 31 ? 0 : reader.number(k);
      if (order == 1) x += last;
      if (order == 2) x += 2 * last - before;
      before = last;
      last = x;
      out[r * columns + c] = x;
    }
  }
  return out;
}

}  // namespace

TEST_CASE("Base64 is that of RFC 4648, section 10") {
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foobar") == "Zm9vYmFy");
}

TEST_CASE("a series reads back to the nearest step, whatever its numbers") {
  for (const std::uint64_t seed : fresh_seeds(60)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::size_t rows = random() % 700, columns = 1 + random() % 4;
    const double size = std::pow(10.0, static_cast<double>(random() % 9) - 3.0), step = 1e-3;
    std::vector<float> values(rows * columns);
    double walk = 0.0;
    for (float& x : values) {
      const double now = size * (static_cast<double>(random() % 2001) - 1000.0) / 1000.0;
      walk += 0.01 * now;
      x = static_cast<float>(seed % 2 == 0 ? now : walk);
    }
    const auto read = unpacked(packed_series(values, columns, step), rows, columns);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double most = 268435456.0, want = static_cast<double>(values[i]) / step;
      CHECK(read[i] == std::llround(std::clamp(want, -most, most)));
    }
  }
}

TEST_CASE("numbers that leap from end to end read back, and those that are none are 0") {
  const float huge = 1e30F, none = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> values{huge, -huge, huge,
                                  none, 0.5F,  std::numeric_limits<float>::infinity()};
  const std::vector<std::int64_t> want{268435456, -268435456, 268435456, 0, 1, 0};
  CHECK(unpacked(packed_series(values, 1, 0.5), values.size(), 1) == want);
}

TEST_CASE("a column that stands still takes seven bits a block") {
  const std::vector<std::uint8_t> states(2560, 0);
  CHECK(packed_series(std::span(states), 1).size() == 12);  // 70 bits: 9 bytes
}
