// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace kinalign {

namespace {

// The powers of ten that a double represents exactly.
constexpr std::array<double, 16> ten{1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                     1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

// "00" to "99": put_decimals() writes two digits at a time.
constexpr std::array<char, 200> digit_pairs = [] {
  std::array<char, 200> pairs{};
  for (std::size_t i = 0; i < 100; ++i) {
    pairs[2 * i] = static_cast<char>('0' + i / 10);
    pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
  }
  return pairs;
}();

bool is_digit(char c) { return static_cast<unsigned>(c - '0') < 10; }

/// For a number out of the range of a double: true if it is too small (1e-999, which becomes 0),
/// false if it is too large (1e999). The power of ten of its first digit other than 0 decides.
bool too_small(std::string_view number) {
  const auto exponent_at = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, exponent_at);
  const auto point = static_cast<std::int64_t>(std::min(digits.find('.'), digits.size()));
  const auto first = static_cast<std::int64_t>(digits.find_first_of("123456789"));
  std::string_view exponent = number.substr(std::min(exponent_at + 1, number.size()));
  const bool negative = exponent.starts_with('-');
  if (negative || exponent.starts_with('+')) exponent.remove_prefix(1);
  std::int64_t power = 0;
  // The limit prevents an overflow if the exponent has many digits.
  for (const char c : exponent) power = std::min(power * 10 + (c - '0'), std::int64_t{1} << 40);
  return point - first + (negative ? -power : power) < 0;
}

/// The general case: more than 15 digits, an exponent, or text that is not a number.
const char* parse_any(const char* at, const char* end, double& value) {
  const char* digits = at + (*at == '-' ? 1 : 0);
  if (digits == end || (!is_digit(*digits) && *digits != '.'))
    return nullptr;  // refuses "inf" and "nan"
  const auto [behind, fault] = std::from_chars(at, end, value);
  // std::from_chars does not report whether a number is too large or too small. A too small number
  // becomes 0 with its sign.
  if (fault == std::errc::result_out_of_range) {
    const std::string_view text(at, static_cast<std::size_t>(behind - at));
    if (!too_small(text)) return nullptr;
    value = *at == '-' ? -0.0 : 0.0;
    return behind;
  }
  return fault == std::errc{} ? behind : nullptr;
}

char* put_whole(char* at, std::int64_t whole) {
  if (whole >= 100) return std::to_chars(at, at + 20, whole).ptr;
  const char* pair = &digit_pairs[static_cast<std::size_t>(2 * whole)];
  if (whole >= 10) *at++ = *pair;
  *at++ = pair[1];
  return at;
}

/// Writes a number below 2^52 with `decimals` digits after the point. `all` is the number in units
/// of 10^-decimals, and `value` is the double nearest to it. Both have the same whole part, because
/// neighbouring doubles are closer together than 10^-decimals. The function is not inlined, because
/// inlining it costs put_number() 1 % of its time.
__attribute__((noinline)) char* put_decimals(char* at, double value, std::int64_t all,
                                             int decimals) {
  const auto power = static_cast<std::int64_t>(ten[static_cast<std::size_t>(decimals)]);
  const auto whole = static_cast<std::int64_t>(value);  // faster than a division of `all`
  std::int64_t fraction = all - whole * power;
  at = put_whole(at, whole);
  if (decimals == 0) return at;
  *at++ = '.';
  int left = decimals;
  // If the number of digits is odd, the last digit is written alone. The others are written in
  // pairs from the right.
  if (left % 2 != 0) {
    at[left - 1] = static_cast<char>('0' + fraction % 10);
    fraction /= 10;
    --left;
  }
  for (; left > 0; left -= 2) {
    std::memcpy(at + left - 2, &digit_pairs[static_cast<std::size_t>(2 * (fraction % 100))], 2);
    fraction /= 100;
  }
  return at + decimals;
}

}  // namespace

const char* parse_number(const char* at, const char* end, double& value) {
  if (at != end && *at == '+') {
    ++at;
    // "+-1" is not a number, but std::from_chars would read "-1" after the sign.
    if (at != end && *at == '-') return nullptr;
  }
  const char* p = at;
  const bool minus = *p == '-';
  p += minus ? 1 : 0;
  // All digits are read as one integer: 12.34 is 1234 / 10^2. With at most 15 digits both numbers
  // are exact doubles, so the single division rounds correctly.
  std::uint64_t whole = 0;
  const char* digits = p;
  while (is_digit(*p)) whole = whole * 10 + static_cast<unsigned>(*p++ - '0');
  auto count = p - digits;
  std::ptrdiff_t after = 0;
  if (*p == '.') {
    const char* fraction = ++p;
    while (is_digit(*p)) whole = whole * 10 + static_cast<unsigned>(*p++ - '0');
    after = p - fraction;
    count += after;
  }
  // `whole` may have overflowed with more digits, so parse_any() reads the text again from its
  // beginning.
  if (count == 0 || count > 15 || (*p | 32) == 'e') return parse_any(at, end, value);
  const double magnitude = static_cast<double>(whole) / ten[static_cast<std::size_t>(after)];
  value = minus ? -magnitude : magnitude;
  return p;
}

bool parse_number(std::string_view text, double& value) {
  // The copy has a fixed size, so longer texts are not accepted.
  if (text.empty() || text.size() > 400) return false;
  std::array<char, 401> copy{};  // ends with a character that can't belong to a number
  std::memcpy(copy.data(), text.data(), text.size());
  const char* end = copy.data() + text.size();
  return parse_number(copy.data(), end, value) == end;
}

int decimals_of(std::string_view number) {
  const auto point = number.find('.');
  if (point == std::string_view::npos) return 0;
  if (number.find_first_of("eE") != std::string_view::npos) return 0;
  return static_cast<int>(number.size() - point - 1);
}

char* put_number(char* at, double value, int decimals) {
  const double scale = ten[static_cast<std::size_t>(decimals)];
  const double magnitude = std::abs(value), scaled = magnitude * scale;
  // Below 2^52 the nearest integer is exact. If any number with these decimals reads back as
  // `value`, this number does.
  if (!(scaled < 4e15)) return std::to_chars(at, at + number_room, value).ptr;
  auto all = static_cast<std::int64_t>(scaled);
  // Rounds up without a branch, which a processor may predict wrongly.
  all += static_cast<std::int64_t>(scaled - static_cast<double>(all) >= 0.5);
  // The digits must read back as the same double. parse_number() divides in the same way.
  if (static_cast<double>(all) / scale != magnitude) {
    return std::to_chars(at, at + number_room, value).ptr;
  }
  if (std::signbit(value)) *at++ = '-';
  return put_decimals(at, magnitude, all, decimals);
}

std::string number_text(double value, int decimals) {
  std::array<char, number_room> room{};
  return {room.data(), put_number(room.data(), value, decimals)};
}

std::string grouped(std::string number) {
  const std::size_t first = number.starts_with('-') ? 1 : 0;
  for (std::size_t at = std::min(number.find('.'), number.size()); at > first + 3;) {
    at -= 3;
    number.insert(at, ",");
  }
  return number;
}

std::string counts_in_words(const std::vector<std::pair<std::uint64_t, std::string>>& counts) {
  std::string text;
  for (const auto& [count, word] : counts) {
    if (count > 0) text += (text.empty() ? "" : ", ") + grouped(count) + " " + word;
  }
  return text;
}

}  // namespace kinalign
