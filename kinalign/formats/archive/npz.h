// SPDX-License-Identifier: Apache-2.0
// Reads all arrays of a numpy NPZ file into memory. An NPZ file is a ZIP file of .npy members.
#pragma once

#include "kinalign/formats/archive/archive.h"
#include "kinalign/numpy/npy.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The lengths of an array's dimensions. The last index varies fastest. Empty: a single value.
using Shape = std::vector<std::uint64_t>;

/// All arrays of a file. They are in memory together, with at most as many bytes as the limits
/// allow.
class Npz {
 public:
  /// Fails if a member is not a .npy file, or if the members together have more than
  /// `limits.bytes`.
  static Result<Npz> read(const ArchiveBytes& bytes, const ArchiveLimits& limits);

  bool has(const std::string& name) const { return arrays_.contains(name); }
  /// Return the values of an array. Fail if the array is absent, or if its type or shape differs
  /// from the wanted one. A length of 0 in `shape` accepts any length.
  Result<std::vector<std::int64_t>> integers(const std::string& name, const Shape& shape) const;
  Result<std::vector<double>> numbers(const std::string& name, const Shape& shape) const;
  Result<std::vector<std::string>> texts(const std::string& name, const Shape& shape) const;

 private:
  Result<const NpyArray*> find(const std::string& name, std::string_view kinds,
                               const Shape& shape) const;

  std::string name_;
  /// The bytes of a member, and the array as a view of them. Elements of a std::map do not move, so
  /// the view stays valid.
  struct Member {
    std::string bytes;
    NpyArray array;
  };
  std::map<std::string, Member> arrays_;
};

}  // namespace kinalign
