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
  char kind = 'f';              // 'i', 'u', 'f', 'b' (true or false), or 'U' (a text)
  std::size_t value_bytes = 8;  // for a text: 4 bytes per character
  std::vector<std::uint64_t> shape;
  std::size_t data_at = 0;  // position of the first value after the header, bytes

  std::uint64_t values() const;
};

/// Fails if the header is malformed, or if the values would need 2^40 bytes or more.
Result<NpyHeader> parse_npy_header(std::string_view bytes, std::string_view name);

/// A view of the bytes that the caller gave to read_npy(), which must exist longer than the view.
struct NpyArray {
  NpyHeader header;
  std::string_view bytes;  // the values, without the header
};

/// Reads a whole file; `name` appears in messages. Fails if the size of the file does not match the
/// shape and the type in the header.
Result<NpyArray> read_npy(std::string_view file, std::string_view name);

/// Return value `index` of an array. integer_at: for kinds 'i', 'u' and 'b'. number_at: for all
/// numbers. text_at: for kind 'U', as UTF-8.
std::int64_t integer_at(const NpyArray& array, std::size_t index);
double number_at(const NpyArray& array, std::size_t index);
std::string text_at(const NpyArray& array, std::size_t index);

}  // namespace kinalign
