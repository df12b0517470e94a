// SPDX-License-Identifier: Apache-2.0
// Reads the arrays of numpy's NPZ, a ZIP of .npy members, all into memory.
#pragma once

#include "kinalign/formats/archive/archive.h"
#include "kinalign/numpy/npy.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The lengths of an array's dimensions, the slowest-varying first. Empty: a single value.
using Shape = std::vector<std::uint64_t>;

/// Memory: all arrays at once, at most as many bytes as the limits allow.
class Npz {
 public:
  /// Members other than .npy are refused. All members together may have at most `limits.bytes`.
  static Result<Npz> read(const ArchiveBytes& bytes, const ArchiveLimits& limits);

  bool has(const std::string& name) const { return arrays_.contains(name); }
  /// Each fails if the array is absent, or if its values or its shape differ from the wanted ones.
  /// A length of 0 in `shape` accepts any length.
  Result<std::vector<std::int64_t>> integers(const std::string& name, const Shape& shape) const;
  Result<std::vector<double>> numbers(const std::string& name, const Shape& shape) const;
  Result<std::vector<std::string>> texts(const std::string& name, const Shape& shape) const;

 private:
  Result<const NpyArray*> find(const std::string& name, std::string_view kinds,
                               const Shape& shape) const;

  std::string name_;
  /// A member's bytes with the array that views them. Nodes of a map keep their place, so the view
  /// stays valid.
  struct Member {
    std::string bytes;
    NpyArray array;
  };
  std::map<std::string, Member> arrays_;
};

}  // namespace kinalign
