// SPDX-License-Identifier: Apache-2.0
// Reads and writes SafeTensors: named arrays of numbers after a JSON header. Layout:
// docs/formats/model.md.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// One array of numbers, as it is used in memory: float, whatever the type in the file was.
struct Tensor {
  std::vector<std::size_t> shape;  // empty: a single number
  std::vector<float> values;       // row-major

  bool operator==(const Tensor&) const = default;
};

/// The content of a file. Maps sort the names, so the same tensors are always written in one order.
struct TensorFile {
  std::map<std::string, std::string> metadata;
  std::map<std::string, Tensor> tensors;  // by name
};

/// Limit of the JSON header; a longer one is refused before it is parsed.
inline constexpr std::size_t most_header_bytes = std::size_t{16} << 20U;

/// Reads a whole file. F16 and BF16 are converted to float; other types are refused. `name` appears
/// in messages only. Fails if the header is not JSON of the expected form, if a name occurs twice,
/// or if the tensors leave gaps, overlap or do not end at the end of the file.
Result<TensorFile> read_safetensors(std::string_view bytes, const std::string& name);

/// The same tensors give the same bytes: names sorted, all values F32, the header padded with
/// blanks to a multiple of 8 bytes. Each tensor must have as many values as its shape states.
std::string write_safetensors(const TensorFile& file);

}  // namespace kinalign
