// SPDX-License-Identifier: Apache-2.0
#include "kinalign/numpy/npy.h"

#include "kinalign/core/numbers.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <utility>

namespace kinalign {

namespace {

// The limit is far above the size of any file that kinalign reads.
constexpr std::uint64_t most_bytes = std::uint64_t{1} << 40;
constexpr std::size_t longest_header = 65536, most_dimensions = 32;

/// Parses the header, a Python dict: {'descr': '<f4', 'fortran_order': False, 'shape': (3, 4), }.
/// numpy evaluates the header as Python. This parser accepts only the form that numpy writes. The
/// keys may stand in any order, each once.
class HeaderText {
 public:
  explicit HeaderText(std::string_view text) : text_(text) {}

  bool parse(NpyHeader& out) {
    if (!take("{")) return false;
    bool descr = false, order = false, shape = false;
    while (!take("}")) {
      const auto key = quoted();
      if (!key || !take(":")) return false;
      bool taken = false;
      if (*key == "descr") taken = !std::exchange(descr, true) && parse_descr(out);
      // True would mean Fortran order, in which the first index varies fastest. Only False is
      // accepted.
      if (*key == "fortran_order") taken = !std::exchange(order, true) && take("False");
      if (*key == "shape") taken = !std::exchange(shape, true) && parse_shape(out);
      if (!taken) return false;
      // numpy writes a comma after the last entry, too.
      if (!take(",") && !next_is('}')) return false;
    }
    skip_blanks();
    return descr && order && shape && text_.empty();
  }

 private:
  void skip_blanks() {
    const auto at = text_.find_first_not_of(" \n");
    text_.remove_prefix(at == text_.npos ? text_.size() : at);
  }
  bool take(std::string_view word) {
    skip_blanks();
    if (!text_.starts_with(word)) return false;
    text_.remove_prefix(word.size());
    return true;
  }
  bool next_is(char c) {
    skip_blanks();
    return text_.starts_with(c);
  }
  std::optional<std::string_view> quoted() {
    if (!take("'")) return std::nullopt;
    const auto end = text_.find('\'');
    if (end == text_.npos) return std::nullopt;
    const std::string_view word = text_.substr(0, end);
    text_.remove_prefix(end + 1);
    return word;
  }
  std::optional<std::uint64_t> number() {
    skip_blanks();
    std::uint64_t value = 0;
    const auto [end, fault] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (fault != std::errc{}) return std::nullopt;
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return value;
  }

  /// Reads the type of the values, for example "<f4", "|u1" or "<U12".
  bool parse_descr(NpyHeader& out) {
    const auto descr = quoted();
    if (!descr || descr->size() < 3) return false;
    const char order = (*descr)[0];
    std::uint64_t size = 0;
    if (!parse_integer(descr->substr(2), size)) return false;
    out.kind = (*descr)[1];
    // numpy stores text as UTF-32, so a text of n characters takes 4 n bytes.
    if (out.kind == 'U') {
      if (order != '<' || size == 0 || size > longest_header) return false;
      out.value_bytes = 4 * size;
      return true;
    }
    const bool whole = out.kind == 'i' || out.kind == 'u';
    const bool known = (out.kind == 'b' && size == 1) ||
                       (whole && (size == 1 || size == 2 || size == 4 || size == 8)) ||
                       (out.kind == 'f' && (size == 4 || size == 8));
    out.value_bytes = size;
    // Single bytes have no byte order. numpy writes '|' for them.
    return known && (order == '<' || (order == '|' && size == 1));
  }

  bool parse_shape(NpyHeader& out) {
    if (!take("(")) return false;
    while (!take(")")) {
      const auto length = number();
      // The product of the lengths is checked in parse_npy_header().
      if (!length || *length > most_bytes || out.shape.size() == most_dimensions) return false;
      out.shape.push_back(*length);
      if (!take(",") && !next_is(')')) return false;
    }
    return true;
  }

  std::string_view text_;
};

template <class Value>
Value value_at(const NpyArray& array, std::size_t index) {
  // memcpy is used, because the values in the file may not be aligned.
  static_assert(std::endian::native == std::endian::little);
  Value value;
  std::memcpy(&value, array.bytes.data() + index * sizeof(Value), sizeof(Value));
  return value;
}

/// Appends a Unicode character as UTF-8. A number that is not a character becomes '?'.
void put_utf8(std::string& out, std::uint32_t code) {
  const auto put = [&out](std::uint32_t byte) { out += static_cast<char>(byte); };
  if (code < 0x80) return put(code);
  // Halves of UTF-16 pairs are not characters.
  if (code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) return put('?');
  if (code < 0x800) {
    put(0xC0 | code >> 6);
  } else {
    if (code < 0x10000) {
      put(0xE0 | code >> 12);
    } else {
      put(0xF0 | code >> 18);
      put(0x80 | (code >> 12 & 0x3F));
    }
    put(0x80 | (code >> 6 & 0x3F));
  }
  put(0x80 | (code & 0x3F));
}

}  // namespace

std::uint64_t NpyHeader::values() const {
  std::uint64_t count = 1;
  for (const std::uint64_t length : shape) count *= length;
  return count;
}

Result<NpyHeader> parse_npy_header(std::string_view bytes, std::string_view name) {
  if (!bytes.starts_with("\x93NUMPY") || bytes.size() < 10) {
    return refuse(name, "a NumPy array (NPY)", "other bytes at the beginning");
  }
  const auto version = static_cast<unsigned char>(bytes[6]);
  if (version < 1 || version > 3) {
    return refuse(name, "an NPY of version 1 to 3", std::to_string(version));
  }
  // Version 1 has two bytes for the header's length, later versions have four.
  const std::size_t length_bytes = version == 1 ? 2 : 4, at = 8 + length_bytes;
  std::size_t length = 0;
  // The length is little-endian: its last byte is the most significant.
  for (std::size_t i = length_bytes; i-- > 0 && bytes.size() >= at;) {
    length = length << 8 | static_cast<unsigned char>(bytes[8 + i]);
  }
  if (bytes.size() < at || length > longest_header || bytes.size() - at < length) {
    return refuse(name, "a complete NPY header",
                  "a header of " + std::to_string(length) + " bytes");
  }
  NpyHeader out;
  const std::string_view text = bytes.substr(at, length);
  if (!HeaderText(text).parse(out)) {
    return refuse(name, "an NPY of numbers or texts, little-endian, in C order", shown(text));
  }
  out.data_at = at + length;
  std::uint64_t all = std::max<std::size_t>(out.value_bytes, 1);
  for (const std::uint64_t one : out.shape) {
    // The check comes before each product, so that no product overflows. A length of 0 counts as 1,
    // so the other lengths are checked, too.
    if (one > 0 && all > most_bytes / one)
      return refuse(name, "an array below 2^40 bytes", "a larger array");
    all *= std::max<std::uint64_t>(one, 1);
  }
  return out;
}

Result<NpyArray> read_npy(std::string_view file, std::string_view name) {
  NpyArray out;
  out.header = KA_TRY(parse_npy_header(file, name));
  out.bytes = file.substr(out.header.data_at);
  const std::uint64_t wanted = out.header.values() * out.header.value_bytes;
  if (out.bytes.size() == wanted) return out;
  return refuse(name, std::to_string(wanted) + " bytes of values",
                std::to_string(out.bytes.size()));
}

// An array of kind 'i' has signed values; the other kinds are read as unsigned.
std::int64_t integer_at(const NpyArray& array, std::size_t index) {
  const auto as = [&]<class Small, class Whole>(Small, Whole) {
    return array.header.kind == 'i' ? static_cast<std::int64_t>(value_at<Small>(array, index))
                                    : static_cast<std::int64_t>(value_at<Whole>(array, index));
  };
  switch (array.header.value_bytes) {
    case 1:
      return as(std::int8_t{}, std::uint8_t{});
    case 2:
      return as(std::int16_t{}, std::uint16_t{});
    case 4:
      return as(std::int32_t{}, std::uint32_t{});
    default:
      return as(std::int64_t{}, std::uint64_t{});
  }
}

double number_at(const NpyArray& array, std::size_t index) {
  if (array.header.kind != 'f') return static_cast<double>(integer_at(array, index));
  return array.header.value_bytes == 4 ? static_cast<double>(value_at<float>(array, index))
                                       : value_at<double>(array, index);
}

std::string text_at(const NpyArray& array, std::size_t index) {
  std::string out;
  // numpy pads short texts with zeros.
  const std::size_t letters = array.header.value_bytes / 4;
  for (std::size_t i = 0; i < letters; ++i) {
    const auto code = value_at<std::uint32_t>(array, index * letters + i);
    if (code == 0) break;
    put_utf8(out, code);
  }
  return out;
}

}  // namespace kinalign
