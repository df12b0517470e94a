// SPDX-License-Identifier: Apache-2.0
// Arrays in numpy's NPY format (numpy.org/doc/stable/reference/generated/numpy.lib.format.html):
// numbers and texts in C order, little-endian. Pickled objects are programs and are refused.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

struct NpyHeader {
  char kind = 'f';              // 'i', 'u', 'f', 'b' (true or false), or 'U': a text
  std::size_t value_bytes = 8;  // for a text: 4 bytes per character
  std::vector<std::uint64_t> shape;
  std::size_t data_at = 0;  // position of the first value, behind the header

  std::uint64_t values() const;
};

/// Fails if the header is malformed, or if the values would need 2^40 bytes or more.
Result<NpyHeader> parse_npy_header(std::string_view bytes, std::string_view name);

/// `bytes` is a part of the bytes that were given to read_npy().
struct NpyArray {
  NpyHeader header;
  std::string_view bytes;  // the values alone
};

/// Reads a whole file; `name` appears in messages. Fails if the file's size is not that of the
/// header and its values.
Result<NpyArray> read_npy(std::string_view file, std::string_view name);

/// Value `index` of an array. integer_at: kinds 'i', 'u' and 'b'; number_at: any number; text_at:
/// kind 'U', as UTF-8.
std::int64_t integer_at(const NpyArray& array, std::size_t index);
double number_at(const NpyArray& array, std::size_t index);
std::string text_at(const NpyArray& array, std::size_t index);

}  // namespace kinalign
