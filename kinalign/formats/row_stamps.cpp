// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/row_stamps.h"

#include "kinalign/core/numbers.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace kinalign {

namespace {

constexpr std::int64_t second_ns = 1'000'000'000;
constexpr int most_digits = 18;           // digits that an int64 can contain
constexpr int most_fraction_digits = 10;  // down to 0.1 ns if the unit is a second

/// A decimal number: "12.50" is whole 12, fraction 5, scale 10.
struct Decimal {
  bool minus = false;
  std::int64_t whole = 0;
  std::uint64_t fraction = 0, scale = 1;
};

bool is_digit(char c) { return static_cast<unsigned>(c - '0') < 10; }

/// Reads plain decimals. Returns false if the text has an exponent or is not a number.
bool parse_decimal(std::string_view text, Decimal& out) {
  std::size_t i = 0;
  if (i < text.size() && (text[i] == '-' || text[i] == '+')) out.minus = text[i++] == '-';
  const std::size_t first = i;
  for (; i < text.size() && is_digit(text[i]); ++i) {
    // The number has too many digits for an int64. through_double() may read the number.
    if (i - first >= most_digits + 1 || out.whole > INT64_MAX / 10 - 1) return false;
    out.whole = out.whole * 10 + (text[i] - '0');
  }
  std::size_t digits = i - first;
  if (i < text.size() && text[i] == '.') {
    const std::size_t point = i++;
    for (; i < text.size() && is_digit(text[i]); ++i, ++digits) {
      // Digits after a tenth of a nanosecond are ignored.
      if (i - point > most_fraction_digits) continue;
      out.fraction = out.fraction * 10 + static_cast<unsigned>(text[i] - '0');
      out.scale *= 10;
    }
  }
  return digits > 0 && i == text.size();
}

/// Reads a stamp with an exponent or with a decimal comma.
std::optional<std::int64_t> through_double(std::string_view text, TimeScale scale) {
  std::string point(text.substr(0, 64));
  std::replace(point.begin(), point.end(), ',', '.');  // French programs write 1,594038E+12
  double value = 0.0;
  if (!parse_number(point, value)) return std::nullopt;
  const double ns =
      (value - static_cast<double>(scale.epoch_s) * 1e9 / static_cast<double>(scale.unit_ns)) *
      static_cast<double>(scale.unit_ns);
  if (!(std::abs(ns) <= static_cast<double>(largest_stamp_ns))) return std::nullopt;
  return std::llround(ns);
}

}  // namespace

std::optional<std::int64_t> parse_stamp(std::string_view text, TimeScale scale) {
  Decimal decimal;
  if (!parse_decimal(text, decimal)) return through_double(text, scale);
  const std::int64_t whole = decimal.minus ? -decimal.whole : decimal.whole;
  // The limit is in the column's unit, so that the product below can't overflow.
  const std::int64_t largest = largest_stamp_ns / scale.unit_ns;
  std::int64_t epoch = 0, units = 0;
  const bool overflow = __builtin_mul_overflow(scale.epoch_s, second_ns / scale.unit_ns, &epoch) ||
                        __builtin_sub_overflow(whole, epoch, &units);
  if (overflow || units > largest || units < -largest) return std::nullopt;
  // The product is below 1e10 * 1e9 + 5e9, which fits into an unsigned 64-bit integer.
  const std::uint64_t part =
      (decimal.fraction * static_cast<std::uint64_t>(scale.unit_ns) + decimal.scale / 2) /
      decimal.scale;
  const auto fraction = static_cast<std::int64_t>(part);
  return units * scale.unit_ns + (decimal.minus ? -fraction : fraction);
}

std::string seconds_text(std::int64_t ns) {
  constexpr std::size_t fraction_digits = 9;
  const std::uint64_t size =
      ns < 0 ? 0 - static_cast<std::uint64_t>(ns) : static_cast<std::uint64_t>(ns);
  std::string digits = std::to_string(size);
  if (digits.size() <= fraction_digits) digits.insert(0, fraction_digits + 1 - digits.size(), '0');
  digits.insert(digits.size() - fraction_digits, ".");
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.ends_with('.')) digits.pop_back();
  return ns < 0 ? "-" + digits : digits;
}

std::int64_t stamp_at_rate(std::uint64_t index, double rate_hz) {
  constexpr double largest =
      4.5e18;  // above the limit of stamps, but a sum with another stamp can't overflow
  return std::llround(std::min(static_cast<double>(index) * 1e9 / rate_hz, largest));
}

RowStamps::RowStamps(bool column, double rate_hz, std::optional<std::int64_t> start_ns)
    : column_(column), rate_hz_(rate_hz), start_ns_(start_ns), settled_(!column) {}

Result<Time> RowStamps::next(std::int64_t ns) {
  if (rows_ == 0) {
    first_ = column_ ? ns : 0;
    if (start_ns_) shift_ = *start_ns_ - first_;
  } else if (!settled_) {
    // If the first stamp repeats, the decision waits for at most `patience` rows.
    stuck_ = ns == first_ && rows_ + 1 >= patience;
    settled_ = ns != first_ || stuck_;
  }
  if (counted()) ns = first_ + stamp_at_rate(rows_, rate_hz_);
  ++rows_;
  std::int64_t shifted = 0;
  const bool overflow = __builtin_add_overflow(ns, shift_, &shifted);
  if (overflow || shifted > largest_stamp_ns || shifted < -largest_stamp_ns) {
    return refuse("a stamp inside +-4e18 ns", std::to_string(ns) + " ns");
  }
  return utc_time(shifted);
}

void RowStamps::settle() {
  // Fewer rows may have the same stamp by chance.
  constexpr std::uint64_t least = 3;
  if (!settled_) stuck_ = rows_ >= least;
  settled_ = true;
}

void RowStamps::restamp(std::vector<Time>& held) const {
  // Without a rate, the rows keep their equal stamps.
  if (!stuck_ || rate_hz_ <= 0.0) return;
  for (std::size_t i = 0; i < held.size(); ++i) {
    held[i] = utc_time(first_ + shift_ + stamp_at_rate(i, rate_hz_));
  }
}

Finding stuck_finding(std::string_view file, const RowStamps& stamps) {
  const bool rate = stamps.rate_hz() > 0.0;
  return {Severity::warning,
          Error{std::string(file), 0, "stamps that change",
                "the same stamp in the first " +
                    std::to_string(std::min(stamps.rows(), RowStamps::patience)) + " rows"},
          rate ? "the rows were stamped by rate_hz" : "the rows have no known time",
          rate ? "" : "set rate_hz to the rate of the device"};
}

}  // namespace kinalign
