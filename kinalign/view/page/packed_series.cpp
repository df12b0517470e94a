// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/packed_series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace kinalign {

namespace {

constexpr std::size_t block_rows = 256;
constexpr unsigned most_zeros = 20, all_zero = 31;

/// `open_` contains the `used_` bits of the incomplete last byte.
class BitWriter {
 public:
  void put(std::uint64_t value, unsigned bits) {
    for (unsigned left = bits; left > 0;) {
      const unsigned take = std::min(left, 8 - used_);
      left -= take;
      open_ = static_cast<std::uint8_t>(open_ << take | ((value >> left) & ((1u << take) - 1)));
      used_ += take;
      if (used_ == 8) flush();
    }
  }
  std::string finish() {
    if (used_ > 0) put(0, 8 - used_);
    return std::move(bytes_);
  }

 private:
  void flush() {
    bytes_ += static_cast<char>(open_);
    open_ = 0;
    used_ = 0;
  }
  std::string bytes_;
  std::uint8_t open_ = 0;
  unsigned used_ = 0;
};

/// Zigzag coding: 0, -1, 1, -2, 2 become 0, 1, 2, 3, 4, so small numbers of both signs stay small.
std::uint32_t unsigned_of(std::int64_t x) {
  return static_cast<std::uint32_t>(x < 0 ? -2 * x - 1 : 2 * x);
}

/// Returns the number of bits that a number needs with k. put_block() uses the same rule.
std::uint64_t cost(std::uint32_t u, unsigned k) {
  const std::uint32_t zeros = u >> k;
  return zeros < most_zeros ? zeros + 1 + k : most_zeros + 32;
}

/// A block as values, differences or second differences, converted to unsigned numbers.
struct Coded {
  std::array<std::uint32_t, block_rows> numbers{};
  std::size_t count = 0;
  unsigned k = all_zero;
  std::uint64_t bits = 0;
};

/// Sets the best k. The best k of a Rice code is near the logarithm of the mean, so a few values
/// near it are tried.
void choose_k(Coded& block) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < block.count; ++i) sum += block.numbers[i];
  if (sum == 0) return;
  const double mean = static_cast<double>(sum) / static_cast<double>(block.count);
  const auto near = static_cast<unsigned>(std::max(0.0, std::floor(std::log2(mean + 1.0))));
  // A block of zeros was handled before; it has k = 31 and no bits.
  block.bits = UINT64_MAX;
  for (unsigned k = near > 1 ? near - 2 : 0; k <= std::min(near + 1, 30u); ++k) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < block.count; ++i) bits += cost(block.numbers[i], k);
    if (bits < block.bits) {
      block.bits = bits;
      block.k = k;
    }
  }
}

/// Codes a block with the given order of differences. `values` begins two values before the block.
Coded coded(std::span<const std::int64_t> values, unsigned order) {
  Coded block;
  block.count = values.size() - 2;
  for (std::size_t i = 0; i < block.count; ++i) {
    const std::int64_t a = values[i], b = values[i + 1], x = values[i + 2];
    block.numbers[i] = unsigned_of(order == 0 ? x : (order == 1 ? x - b : x - 2 * b + a));
  }
  choose_k(block);
  return block;
}

/// Writes a block with the order of differences that needs the fewest bits.
void put_block(std::span<const std::int64_t> values, BitWriter& out) {
  unsigned best = 0;
  Coded block = coded(values, 0);
  // Values are best for constant columns, differences for steady motion, second differences for
  // smooth motion.
  for (unsigned order = 1; order <= 2; ++order) {
    Coded other = coded(values, order);
    if (other.bits >= block.bits) continue;
    block = other;
    best = order;
  }
  out.put(best, 2);
  out.put(block.k, 5);
  if (block.k == all_zero) return;
  for (std::size_t i = 0; i < block.count; ++i) {
    const std::uint32_t u = block.numbers[i], zeros = u >> block.k;
    if (zeros < most_zeros) {
      out.put(1, zeros + 1);
      out.put(u, block.k);
    } else {
      out.put(0, most_zeros);
      out.put(u, 32);
    }
  }
}

/// Packs the numbers that `at(row, column)` returns. All columns share one stream of bits, so only
/// its end is padded to a byte.
template <class At>
std::string packed(std::size_t rows, std::size_t columns, At at) {
  BitWriter out;
  // With these zeros the first rows are coded like all other rows.
  std::vector<std::int64_t> values(rows + 2);  // with two leading zeros
  // Columns are coded one after another, because values of neighbouring times are similar.
  for (std::size_t c = 0; c < columns; ++c) {
    for (std::size_t r = 0; r < rows; ++r) values[r + 2] = at(r, c);
    for (std::size_t first = 0; first < rows; first += block_rows) {
      const std::size_t count = std::min(block_rows, rows - first);
      put_block(std::span(values).subspan(first, count + 2), out);
    }
  }
  return base64(out.finish());
}

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    // Three bytes become four digits of six bits.
    std::uint32_t group = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += k <= count ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return out;
}

std::string packed_series(std::span<const float> values, std::size_t columns, double step) {
  if (columns == 0) return "";
  constexpr double most = 268435456.0;  // 2^28; second differences then fit into 31 bits
  return packed(values.size() / columns, columns, [&](std::size_t r, std::size_t c) {
    const double x = static_cast<double>(values[r * columns + c]) / step;
    return std::isfinite(x) ? static_cast<std::int64_t>(std::llround(std::clamp(x, -most, most)))
                            : std::int64_t{0};
  });
}

std::string packed_series(std::span<const std::uint8_t> values, std::size_t columns) {
  if (columns == 0) return "";
  return packed(values.size() / columns, columns, [&](std::size_t r, std::size_t c) {
    return static_cast<std::int64_t>(values[r * columns + c]);
  });
}

}  // namespace kinalign
