// SPDX-License-Identifier: Apache-2.0
// The arrays of numpy's NPZ, a ZIP of .npy members, all of them in memory.
#pragma once

#include "kinalign/formats/archive/archive.h"
#include "kinalign/formats/archive/npy.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

using Shape = std::vector<std::uint64_t>;

class Npz {
 public:
  /// Members that are no arrays are refused; all of them together have at most `limits.bytes`.
  static Result<Npz> read(const ArchiveBytes& bytes, const ArchiveLimits& limits);

  bool has(const std::string& name) const { return arrays_.contains(name); }
  /// Each fails where there is no such array, of such values, of that shape. A length of 0 in
  /// `shape` stands for any.
  Result<std::vector<std::int64_t>> integers(const std::string& name, const Shape& shape) const;
  Result<std::vector<double>> numbers(const std::string& name, const Shape& shape) const;
  Result<std::vector<std::string>> texts(const std::string& name, const Shape& shape) const;

 private:
  Result<const NpyArray*> find(const std::string& name, std::string_view kinds,
                               const Shape& shape) const;

  std::string name_;
  std::map<std::string, NpyArray> arrays_;
};

}  // namespace kinalign
