// SPDX-License-Identifier: Apache-2.0
// SafeTensors: named arrays of numbers behind a JSON header. Layout: docs/formats/model.md.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

struct Tensor {
  std::vector<std::size_t> shape;  // empty: one number
  std::vector<float> values;       // row-major

  bool operator==(const Tensor&) const = default;
};

struct TensorFile {
  std::map<std::string, std::string> metadata;
  std::map<std::string, Tensor> tensors;  // by name
};

inline constexpr std::size_t most_header_bytes = std::size_t{16} << 20U;

/// Reads a whole file. F16 and BF16 are widened to float; other types are refused. `name` appears
/// in messages only. Fails where the header is no JSON of the expected form, where a name occurs
/// twice, or where the tensors leave gaps, overlap or do not end with the file.
Result<TensorFile> read_safetensors(std::string_view bytes, const std::string& name);

/// The same tensors give the same bytes: names in order, all values F32, the header padded with
/// blanks to a multiple of 8 bytes. Each tensor must have as many values as its shape says.
std::string write_safetensors(const TensorFile& file);

}  // namespace kinalign
