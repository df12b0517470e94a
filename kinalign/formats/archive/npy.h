// SPDX-License-Identifier: Apache-2.0
// An array of numpy's NPY (numpy.org/doc/stable/reference/generated/numpy.lib.format.html): numbers
// and texts in C order, little-endian. Pickled objects are programs and are refused.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

struct NpyHeader {
  char kind = 'f';              // 'i', 'u', 'f', or 'U': a text
  std::size_t value_bytes = 8;  // of a text: 4 for each of its characters
  std::vector<std::uint64_t> shape;
  std::size_t data_at = 0;  // behind the header

  std::uint64_t values() const;
};

/// Fails where the header is none, or where the values would need 2^40 bytes or more.
Result<NpyHeader> parse_npy_header(std::string_view bytes, std::string_view name);

struct NpyArray {
  NpyHeader header;
  std::string bytes;  // of the values
};

/// A whole file; `name` appears in messages. Fails where other than the values' bytes stand behind
/// the header.
Result<NpyArray> read_npy(std::string&& file, std::string_view name);

/// Value `index` of an array of 'i' or 'u'; of any numbers; of texts as UTF-8.
std::int64_t integer_at(const NpyArray& array, std::size_t index);
double number_at(const NpyArray& array, std::size_t index);
std::string text_at(const NpyArray& array, std::size_t index);

}  // namespace kinalign
